#include <gtest/gtest.h>

#include "tools/base/limits/structured_text.h"

namespace limits {
namespace {

std::string Nested(int depth, const char* open, const char* close) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += open;
  for (int i = 0; i < depth; ++i) text += close;
  return text;
}

TEST(Json, DepthIsBounded) {
  EXPECT_EQ(JsonProblem(Nested(kDeepestJson, "[", "]")), "");
  EXPECT_EQ(JsonProblem(Nested(kDeepestJson + 1, "[", "]")), "nested more than 100 deep");
  EXPECT_EQ(JsonProblem(Nested(kDeepestJson, "{\"a\": ", "}")), "");
  EXPECT_NE(JsonProblem(Nested(kDeepestJson + 1, "{\"a\": ", "}")), "");
}

TEST(Json, BracketsInTextsAndBesideEachOtherDoNotCount) {
  EXPECT_EQ(JsonProblem("\"" + std::string(1000, '[') + "\""), "");
  EXPECT_EQ(JsonProblem("\"\\\"" + std::string(1000, '{') + "\""), "") << "an escaped quote ends no text";
  EXPECT_NE(JsonProblem("\"\\\\\"" + std::string(1000, '[')), "") << "an escaped backslash before the quote does";
  std::string many = "[";
  for (int i = 0; i < 1000; ++i) many += "[],";
  EXPECT_EQ(JsonProblem(many + "0]"), "");
}

}  // namespace
}  // namespace limits
