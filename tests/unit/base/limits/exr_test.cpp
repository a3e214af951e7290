#include <gmock/gmock.h>

#include "tools/base/limits/picture.h"

namespace limits {
namespace {

using testing::HasSubstr;

std::string Number(std::int64_t value) {
  std::string text;
  for (int i = 0; i < 4; ++i) text += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
  return text;
}
std::string Attribute(const std::string& name, const std::string& type, const std::string& data) {
  return name + '\0' + type + '\0' + Number(static_cast<std::int64_t>(data.size())) + data;
}
std::string Window(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) {
  return Attribute("dataWindow", "box2i", Number(x0) + Number(y0) + Number(x1) + Number(y1));
}
std::string Start(bool many_parts = false) {
  return std::string("\x76\x2f\x31\x01\x02") + (many_parts ? '\x10' : '\0') + std::string(2, '\0');
}
const std::string kEnd(1, '\0');

std::string Problem(const std::string& file) {
  return ExrProblem({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
}

TEST(Exr, UsualHeadersPass) {
  EXPECT_EQ(Problem(Start() + Window(-5, -5, 634, 474) + kEnd + "pixels"), "");
  EXPECT_EQ(Problem(Start(true) + Window(0, 0, 7, 5) + kEnd + Window(0, 0, 7, 5) + kEnd + kEnd + "pixels"), "");
  EXPECT_EQ(
      Problem(Start() + Attribute("tiles", "tiledesc", Number(64) + Number(64) + kEnd) + Window(0, 0, 7, 5) + kEnd),
      "");
}

TEST(Exr, SizesAreBoundedInEveryPart) {
  EXPECT_EQ(Problem(Start() + Window(0, 0, 40000, 10) + kEnd), "40001 x 11 pixels: a side may have 32768 at most");
  EXPECT_THAT(Problem(Start() + Window(0, 0, 8191, 8191) + kEnd), HasSubstr("8192 x 8192 pixels in "));
  EXPECT_THAT(Problem(Start(true) + Window(0, 0, 7, 5) + kEnd + Window(0, 0, 40000, 5) + kEnd + kEnd),
              HasSubstr("40001 x 6"));
  EXPECT_EQ(Problem(Start() + Window(3, 0, 2, 10) + kEnd), "its header has no size");
  EXPECT_EQ(Problem(Start() + Window(-2147483648, 0, 2147483647, 0) + kEnd),
            "4294967296 x 1 pixels: a side may have 32768 at most");
  EXPECT_THAT(Problem(Start() + Attribute("tiles", "tiledesc", Number(1 << 20) + Number(64) + kEnd) + kEnd),
              HasSubstr("tiles: 1048576 x 64 pixels"));
}

TEST(Exr, AttributesAreAsLongAsTheirTypes) {
  const std::string channel = std::string("Y") + '\0' + std::string(16, '\0');
  EXPECT_EQ(Problem(Start() + Attribute("channels", "chlist", channel + channel + kEnd) + Window(0, 0, 7, 5) + kEnd),
            "");
  EXPECT_EQ(Problem(Start() + Attribute("channels", "chlist", channel + kEnd + "more") + kEnd),
            "its attribute 'channels' is not as long as its type");
  EXPECT_EQ(Problem(Start() + Attribute("channels", "chlist", channel) + kEnd),
            "its attribute 'channels' is not as long as its type");
  EXPECT_EQ(Problem(Start() + Attribute("speed", "float", "12345") + kEnd),
            "its attribute 'speed' is not as long as its type");
  EXPECT_EQ(Problem(Start() + Attribute("small", "preview", Number(1) + Number(2) + "12345678") + kEnd), "");
  EXPECT_THAT(Problem(Start() + Attribute("small", "preview", Number(9) + Number(2) + "12345678") + kEnd),
              HasSubstr("not as long as its type"));
  EXPECT_THAT(Problem(Start() + Attribute("views", "stringvector", Number(1 << 30)) + kEnd),
              HasSubstr("of a type that is not used here"));
}

TEST(Exr, AttributesAreNoLargerThanTheFile) {
  const std::string promise = std::string("comment") + '\0' + "text" + '\0' + Number(1 << 30) + "x";
  EXPECT_EQ(Problem(Start() + promise + kEnd), "its attribute 'comment' goes beyond the file's end");
  EXPECT_EQ(Problem(Start() + Window(0, 0, 7, 5)), "its header breaks off");
  EXPECT_EQ(Problem("\x76"), "its header breaks off");
}

}  // namespace
}  // namespace limits
