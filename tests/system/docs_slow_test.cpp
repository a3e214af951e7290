// All commands of the docs pages that have slow ones.
#include <gtest/gtest.h>

#include "tests/system/doc_page.h"

namespace vobench::system_test {
namespace {

class SlowDocsTest : public testing::TestWithParam<std::string> {};

TEST_P(SlowDocsTest, EveryCommandWorks) {
  const DocPage page = ReadPage(GetParam());
  if (page.has_slow_commands) {
    EXPECT_EQ(WhatFails(page, Speed::slow), "");
  }
}

INSTANTIATE_TEST_SUITE_P(All, SlowDocsTest, testing::ValuesIn(PageNames()),
                         [](const auto& page) { return std::filesystem::path(page.param).stem().string(); });

}  // namespace
}  // namespace vobench::system_test
