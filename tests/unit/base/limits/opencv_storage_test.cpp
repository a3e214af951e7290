#include <gtest/gtest.h>

#include "tools/base/limits/structured_text.h"

namespace limits {
namespace {

std::string Times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

const std::string kXml = "<?xml version=\"1.0\"?>\n<opencv_storage>\n";

TEST(OpenCvStorage, HowDeepItGoesIsBounded) {
  EXPECT_EQ(OpenCvStorageProblem(kXml + Times(kDeepestStorage - 1, "<a>") + "</opencv_storage>"), "");
  EXPECT_EQ(OpenCvStorageProblem(kXml + Times(kDeepestStorage, "<a>") + "</opencv_storage>"),
            "nested more than 100 deep");
  EXPECT_EQ(OpenCvStorageProblem(kXml + "<a type_id="), "cut off: it does not end with </opencv_storage>");
  EXPECT_EQ(OpenCvStorageProblem(kXml + std::string(1, '\0')), "no text: it has a byte of zero");
  EXPECT_EQ(OpenCvStorageProblem(std::string(kMostStorageBytes + 1, ' ')), "larger than 1048576 bytes");
}

TEST(OpenCvStorage, WhatCalibrationsHavePasses) {
  EXPECT_EQ(OpenCvStorageProblem(kXml + "<data>" + Times(1000, "-1.5e-01 ") + "0.</data></opencv_storage>\n"), "");
  EXPECT_EQ(OpenCvStorageProblem(kXml + Times(1000, "<a>1</a>\n") + "</opencv_storage>"), "");
}

}  // namespace
}  // namespace limits
