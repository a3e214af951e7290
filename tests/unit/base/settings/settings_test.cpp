#include "tools/base/settings/settings.h"

#include <gmock/gmock.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace settings {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// All problems as text, or "" when there are none.
std::string Problems(const Document& document) {
  try {
    document.ThrowIfBad();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Settings, ReadsEveryType) {
  Document document = Document::FromText(
      "d: 8 ms\ni: -3\nl: 9000000000\nu: 18446744073709551615\nb: true\ns: two words\nq: '12'\n"
      "a: [1 cm, 2, 3]\nv: [1, 2]\nt: [x, y]\nc: beta\nsub: {deep: {x: 4}}\n",
      "f.yaml");
  Section root = document.root();
  double d = 0, x = 0;
  int i = 0;
  std::int64_t l = 0;
  std::uint64_t u = 0;
  bool b = false;
  std::string s, q;
  std::array<double, 3> a{};
  std::vector<double> v;
  std::vector<std::string> t;
  enum class Choice { alpha, beta } c = Choice::alpha;
  EXPECT_TRUE(root.Read("d", d, Unit::time));
  EXPECT_TRUE(root.Read("i", i));
  EXPECT_TRUE(root.Read("l", l));
  EXPECT_TRUE(root.Read("u", u));
  EXPECT_TRUE(root.Read("b", b));
  EXPECT_TRUE(root.Read("s", s));
  EXPECT_TRUE(root.Read("q", q));
  EXPECT_TRUE(root.Read("a", a, Unit::length));
  EXPECT_TRUE(root.Read("v", v));
  EXPECT_TRUE(root.Read("t", t));
  EXPECT_TRUE(root.ReadChoice("c", c, {{"alpha", Choice::alpha}, {"beta", Choice::beta}}));
  EXPECT_TRUE(root.Child("sub").Child("deep").Read("x", x));
  EXPECT_EQ(Problems(document), "");
  EXPECT_EQ(d, 0.008);
  EXPECT_EQ(i, -3);
  EXPECT_EQ(l, 9000000000);
  EXPECT_EQ(u, 18446744073709551615u);
  EXPECT_TRUE(b);
  EXPECT_EQ(s, "two words");
  EXPECT_EQ(q, "12");
  EXPECT_THAT(a, ElementsAre(0.01, 2, 3));
  EXPECT_THAT(v, ElementsAre(1, 2));
  EXPECT_THAT(t, ElementsAre("x", "y"));
  EXPECT_EQ(c, Choice::beta);
  EXPECT_EQ(x, 4);
}

TEST(Settings, WhatIsAbsentKeepsItsDefault) {
  Document document = Document::FromText("", "f.yaml");
  double d = 2.5;
  std::vector<double> v{1};
  EXPECT_FALSE(document.root().Read("d", d));
  EXPECT_FALSE(document.root().Child("none").Child("deeper").Read("d", d));
  EXPECT_FALSE(document.root().Read("v", v));
  EXPECT_TRUE(document.root().List("list").empty());
  EXPECT_EQ(Problems(document), "");
  EXPECT_EQ(d, 2.5);
  EXPECT_THAT(v, ElementsAre(1));
}

TEST(Settings, AllProblemsAreNamedAtOnceWithTheirPlaces) {
  Document document = Document::FromText(
      "name: [a]\n"
      "sensor: {expossure: 3 ms, exposure: 8 px, gain: 1e999}\n"
      "camera: {widht: 3}\n"
      "keys:\n"
      "  - {p: [1, nan, x]}\n"
      "  - p: [1, 2]\n"
      "kind: bta\n"
      "flag: yes\n"
      "name: twice\n",
      "f.yaml");
  Section root = document.root();
  std::string name;
  double exposure = 1, gain = 2;
  int width = 3;
  bool flag = false;
  std::array<double, 3> p{};
  enum class Choice { alpha, beta } kind = Choice::alpha;
  root.Read("name", name);
  root.Child("sensor").Read("exposure", exposure, Unit::time);
  root.Child("sensor").Read("gain", gain);
  root.Child("camera").Require("width", width);
  for (Section& key : root.List("keys")) key.Read("p", p);
  root.ReadChoice("kind", kind, {{"alpha", Choice::alpha}, {"beta", Choice::beta}});
  root.Read("flag", flag);
  root.Require("missing", gain);
  EXPECT_EQ(
      Problems(document),
      "f.yaml: missing key 'missing'\n"
      "f.yaml:1:7: 'name': expected a text, not a list\n"
      "f.yaml:2:10: unknown key 'expossure'; did you mean 'exposure'?\n"
      "f.yaml:2:37: 'sensor.exposure': '8 px' is not a time: expected a number with s, ms, us, ns, min, or a bare "
      "number of s\n"
      "f.yaml:2:49: 'sensor.gain': '1e999' is out of the range of numbers\n"
      "f.yaml:3:9: missing key 'camera.width'\n"
      "f.yaml:3:10: unknown key 'widht'; did you mean 'width'?\n"
      "f.yaml:5:13: 'keys.0.p': 'nan' is not a finite number\n"
      "f.yaml:5:18: 'keys.0.p': 'x' is not a number: expected a bare number\n"
      "f.yaml:6:8: 'keys.1.p': expected 3 numbers, not 2\n"
      "f.yaml:7:7: 'kind': 'bta' is not known; did you mean 'beta'?\n"
      "f.yaml:8:7: 'flag': 'yes' is neither true nor false\n"
      "f.yaml:9:1: duplicate key 'name', given already on line 1");
  EXPECT_EQ(exposure, 1) << "what is bad leaves the default";
  EXPECT_EQ(gain, 2);
}

TEST(Settings, SectionsAndListsMustBeSuch) {
  Document document = Document::FromText("a: 3\nb: {x: 1}\nc: [{y: 1}, 2]\nd:\ne: [1]\n", "f.yaml");
  Section root = document.root();
  double value = 0;
  root.Child("a").Read("x", value);
  root.List("b");
  for (Section& item : root.List("c")) item.Read("y", value);
  EXPECT_FALSE(root.Child("d").Read("x", value)) << "nothing is an empty section";
  root.Read("e", value);
  EXPECT_EQ(Problems(document),
            "f.yaml:1:4: 'a': expected a section, not '3'\n"
            "f.yaml:2:4: 'b': expected a list of sections, not a section\n"
            "f.yaml:3:13: 'c': expected a list of sections, not of '2'\n"
            "f.yaml:5:4: 'e': expected a number, not a list");
}

TEST(Settings, AKeyWithoutValueIsAProblemForAValue) {
  Document document = Document::FromText("x:\ny: ~\nz: ''\n", "f.yaml");
  double x = 1;
  std::string y = "y", z = "z";
  document.root().Read("x", x);
  document.root().Read("y", y);
  document.root().Read("z", z);
  EXPECT_EQ(Problems(document),
            "f.yaml:1:1: 'x': expected a number, not nothing\n"
            "f.yaml:2:1: 'y': expected a text, not nothing\n"
            "f.yaml:3:4: 'z': is empty");
}

TEST(Settings, OtherReadersSectionsAreIgnored) {
  Document document = Document::FromText("mine: 1\nodometry: {any: [thing]}\n", "f.yaml");
  double mine = 0;
  document.root().Read("mine", mine);
  EXPECT_THAT(Problems(document), HasSubstr("unknown key 'odometry'"));
  document.root().Ignore("odometry");
  EXPECT_EQ(Problems(document), "");

  Document other = Document::FromText("mine: 1\nodometry: {any: 1, typo: 2}\n", "f.yaml");
  other.root().Child("odometry").Read("any", mine);
  other.root().IgnoreRest();
  EXPECT_EQ(Problems(other), "f.yaml:2:20: unknown key 'typo'; known: any") << "only the root's rest is ignored";
}

TEST(Settings, AnAllowedKeyIsKnownThoughNotRead) {
  Document document = Document::FromText("look_at: 1\norientatoin: 2\n", "f.yaml");
  document.root().Allow("look_at");
  document.root().Allow("orientation");
  EXPECT_EQ(Problems(document), "f.yaml:2:1: unknown key 'orientatoin'; did you mean 'orientation'?");
  EXPECT_EQ(document.Resolved(), "{}");
}

TEST(Settings, ReadersRejectWithAPlace) {
  Document document = Document::FromText("a:\n  b: {c: 4}\n", "f.yaml");
  Section root = document.root();
  double c = 0;
  root.Child("a").Child("b").Read("c", c);
  root.Reject("a.b.c", "c is wrong");
  root.Child("a").Reject("b.none", "b lacks something");
  root.Reject("none", "no place");
  EXPECT_EQ(Problems(document), "f.yaml: no place\nf.yaml:2:6: b lacks something\nf.yaml:2:10: c is wrong");
}

TEST(Settings, FilesThatCannotBeRead) {
  const auto message = [](const std::filesystem::path& path) {
    try {
      Document::FromFile(path);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message("/nowhere/f.yaml"), "/nowhere/f.yaml: cannot be read: No such file or directory");
  EXPECT_EQ(message("/"), "/: is a folder, not a file");
  const std::string longer_than_names_are(300, 'n');
  EXPECT_EQ(message(longer_than_names_are), longer_than_names_are + ": cannot be read: File name too long");
}

TEST(Settings, FromFileReadsTheFile) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "vobench_settings_test.yaml";
  std::ofstream(path) << "a: 3\n";
  Document document = Document::FromFile(path);
  int a = 0, b = 0;
  EXPECT_TRUE(document.root().Read("a", a));
  document.root().Require("b", b);
  EXPECT_EQ(a, 3);
  EXPECT_EQ(Problems(document), path.string() + ": missing key 'b'");
  std::filesystem::remove(path);
}

TEST(Settings, ADefaultWithoutANameIsOurBug) {
  Document document = Document::FromText("", "f.yaml");
  int choice = 3;
  EXPECT_THROW(document.root().ReadChoice("c", choice, {{"one", 1}, {"two", 2}}), std::logic_error);
}

TEST(Settings, DistributionsAreDrawnByTheirKeys) {
  Document document = Document::FromText(R"(
a: {uniform: [10 ms, 20 ms]}
list: [{b: {log_uniform: [1, 100]}}, {b: {one_of: [x, y, {one_of: [z]}, w]}}]
section: {one_of: [{c: 1}, {c: 2}]}
other: {uniform: 3, more: 4}
)",
                                         "draw.yaml");
  std::vector<std::string> asked;
  const auto drawn = document.Draw([&](std::string_view path) {
    asked.emplace_back(path);
    return path == "a" ? 0.25 : 0.5;
  });
  EXPECT_THAT(asked, ElementsAre("a", "list.0.b", "list.1.b", "list.1.b", "section"));
  Section root = document.root();
  double a = 0, b = 0;
  std::string z;
  int c = 0;
  root.Read("a", a, Unit::time);
  std::vector<Section> list = root.List("list");
  list[0].Read("b", b);
  list[1].Read("b", z);
  root.Child("section").Read("c", c);
  root.Ignore("other");
  EXPECT_EQ(Problems(document), "");
  EXPECT_DOUBLE_EQ(a, 0.0125);
  EXPECT_DOUBLE_EQ(b, 10);
  EXPECT_EQ(z, "z");
  EXPECT_EQ(c, 2);
  ASSERT_EQ(drawn.size(), 5u);
  EXPECT_EQ(drawn[0], (std::pair<std::string, std::string>("a", "12.5 ms")));
}

TEST(Settings, BadDistributionsAreNamed) {
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"a: {uniform: [1 s, 2 ms]}", "expected two numbers of one unit, the smaller first"},
           {"a: {uniform: [2, 1]}", "expected two numbers of one unit, the smaller first"},
           {"a: {uniform: 3}", "expected a list"},
           {"a: {log_uniform: [0, 1]}", "expected bounds above 0"},
           {"a: {one_of: []}", "expected a list"}}) {
    Document document = Document::FromText(text, "draw.yaml");
    document.Draw([](std::string_view) { return 0.5; });
    document.root().Ignore("a");
    EXPECT_THAT(Problems(document), HasSubstr("draw.yaml:1:4: 'a': ")) << text;
    EXPECT_THAT(Problems(document), HasSubstr(message)) << text;
  }
}

}  // namespace
}  // namespace settings
