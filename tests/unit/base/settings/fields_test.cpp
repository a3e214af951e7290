#include "tools/base/settings/fields.h"

#include <gmock/gmock.h>

#include <cmath>
#include <optional>
#include <set>

#include "tools/base/settings/field_reader.h"

namespace settings {
namespace {
using testing::ElementsAre;

enum class Shape { round, square };

struct Inner {
  double share = 0.5;
  int side = 3;
};
struct Direction {
  double x = 0, y = 1, z = 0;
};
struct Example {
  Shape shape = Shape::round;
  double exposure_s = 0.01;
  int rays = 64;
  bool on = true;
  std::optional<double> shutter_s = {};
  Direction up = {};
  Inner inner = {};
  double k1 = 0, k4 = 0;
};

template <class V>
void Visit(V& v, Inner& p) {
  v("share", p.share, {Range{.min = 0, .max = 1, .above_min = true}, "of all"});
  v("side", p.side, {Unit::pixel, Range::OddAtLeast(1), "of the window"});
}
template <class V>
void Visit(V& v, Example& p) {
  v.Renamed("form", "shape");
  v.Renamed("shape", "circle", "round");
  v("shape", p.shape, {{"round", Shape::round}, {"square", Shape::square}}, "of it");
  v("exposure", p.exposure_s, {Unit::time, Range{0, 10}, "time"});
  v("rays", p.rays, {Range::PowerOfTwo(1 << 20), "number"});
  v("on", p.on, {"whether"});
  v("shutter", p.shutter_s, {Unit::time, Range{-1, 1}, "readout"});
  v("up", p.up, {Unit::length, Range{-10, 10}, "where"});
  v.Child("inner", p.inner);
  v.Child("lens", [&](auto& lens) {
    lens("k1", p.k1, {"radial"});
    if (p.shape == Shape::square) lens("k4", p.k4, {"of a square one"});
  });
}

std::vector<std::string> Keys(const Example& example) {
  Example copy = example;
  FieldCheck check;
  Visit(check, copy);
  std::vector<std::string> keys;
  for (const FieldProblem& problem : check.problems) keys.push_back(problem.key);
  return keys;
}

TEST(FieldRange, EndsAndKinds) {
  EXPECT_TRUE(Range::Positive().Holds(1e-300));
  EXPECT_FALSE(Range::Positive().Holds(0));
  EXPECT_TRUE((Range{0, 1}).Holds(0) && (Range{0, 1}).Holds(1));
  EXPECT_FALSE(Range::Between(0, 1).Holds(0) || Range::Between(0, 1).Holds(1));
  EXPECT_TRUE(Range::OddAtLeast(3).Holds(3));
  EXPECT_FALSE(Range::OddAtLeast(3).Holds(1) || Range::OddAtLeast(3).Holds(4));
  EXPECT_TRUE(Range::PowerOfTwo(8).Holds(1) && Range::PowerOfTwo(8).Holds(8));
  EXPECT_FALSE(Range::PowerOfTwo(8).Holds(0) || Range::PowerOfTwo(8).Holds(6) || Range::PowerOfTwo(8).Holds(16));
  EXPECT_FALSE(Range().Holds(NAN) || Range().Holds(INFINITY));
}

TEST(FieldRange, Words) {
  EXPECT_EQ(Rule({}, Unit::time), "must be finite");
  EXPECT_EQ(Rule({0, 100000}, Unit::none), "must lie in 0 ... 100000");
  EXPECT_EQ(Rule({0, 0.01}, Unit::time), "must lie in 0 ... 0.01 s");
  EXPECT_EQ(Rule({.min = 0, .max = 1, .above_min = true}, Unit::length), "must be above 0 and at most 1 m");
  EXPECT_EQ(Rule(Range::AtLeast(2), Unit::pixel), "must be at least 2 px");
  EXPECT_EQ(Rule(Range::OddAtLeast(1), Unit::none), "must be odd and at least 1");
  EXPECT_EQ(Rule(Range::PowerOfTwo(16), Unit::none), "must be a power of two and at most 16");
}

TEST(FieldCheck, EveryFieldOutOfItsRange) {
  EXPECT_THAT(Keys({}), ElementsAre());
  EXPECT_THAT(Keys({.exposure_s = -1, .rays = 3, .shutter_s = 2, .up = {0, NAN, 0}, .inner = {0, 4}, .k4 = NAN}),
              ElementsAre("exposure", "rays", "shutter", "up", "inner.share", "inner.side"))
      << "k4 is no field of a round one";
  EXPECT_THAT(Keys({.shape = Shape::square, .k1 = NAN, .k4 = INFINITY}), ElementsAre("lens.k1", "lens.k4"));
}

TEST(FieldRows, DefaultsRangesAndHelpOfAllVariants) {
  FieldRows table;
  Example round, square{.shape = Shape::square};
  Visit(table, round);
  Visit(table, square);
  std::string text;
  for (const FieldRow& row : table.rows) text += row.key + "|" + row.value + "|" + row.range + "|" + row.help + "\n";
  EXPECT_EQ(text,
            "shape|round|round, square|of it\n"
            "exposure|0.01 s|0 ... 10 s|time\n"
            "rays|64|a power of two and at most 1048576|number\n"
            "on|true|true, false|whether\n"
            "shutter|none|-1 ... 1 s|readout\n"
            "up|0, 1, 0 m|-10 ... 10 m|where\n"
            "inner.share|0.5|above 0 and at most 1|of all\n"
            "inner.side|3 px|odd and at least 1 px|of the window\n"
            "lens.k1|0||radial\n"
            "lens.k4|0||of a square one\n");
}

std::string Read(const std::string& text, Example& example) {
  Document document = Document::FromText(text, "f.yaml");
  ReadFields(document.root(), example);
  try {
    document.ThrowIfBad();
  } catch (const Error& error) {
    return error.what();
  }
  return document.Resolved();
}

TEST(FieldReader, ReadsWhatTheTableNamesAndResolvesTheRest) {
  Example example;
  const std::string resolved = Read(
      "{shape: square, exposure: 5 ms, shutter: 20 ms, up: [1, 2, 3], inner: {side: 5}, lens: {k4: 0.1}}", example);
  EXPECT_EQ(example.shape, Shape::square);
  EXPECT_EQ(example.exposure_s, 0.005);
  EXPECT_EQ(example.shutter_s, 0.02);
  EXPECT_EQ(example.up.z, 3);
  EXPECT_EQ(example.inner.side, 5);
  EXPECT_EQ(example.k4, 0.1);
  Example again;
  EXPECT_EQ(Read(resolved, again), resolved);
  Example other;
  EXPECT_EQ(Read("{}", other).find("shutter"), std::string::npos) << "an optional field that is not given";
}

TEST(FieldReader, EveryProblemAtItsPlace) {
  Example example;
  EXPECT_EQ(Read("exposure: 20 s\ninner: {side: 4}\nrays: 3\nlens: {k4: 0}\n", example),
            "f.yaml:1:11: 'exposure': '20 s' must lie in 0 ... 10 s\n"
            "f.yaml:2:15: 'inner.side': '4' must be odd and at least 1\n"
            "f.yaml:3:7: 'rays': '3' must be a power of two and at most 1048576\n"
            "f.yaml:4:8: unknown key 'k4'; did you mean 'k1'?");
  EXPECT_EQ(Read("form: round", example), "f.yaml:1:7: 'form' has a new name: 'shape'");
  EXPECT_EQ(Read("shape: circle", example), "f.yaml:1:8: 'shape': 'circle' has a new name: 'round'");
}

struct Turn {
  double x = 0, y = 0, z = 0, w = 1;
};
double length(const Turn& q) { return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w); }
Turn normalize(const Turn& q) { return {q.x / length(q), q.y / length(q), q.z / length(q), q.w / length(q)}; }
struct Placed {
  Turn turn = {};
  std::set<Shape> shapes = {Shape::round};
  int count = 1;
};
template <class V>
void Visit(V& v, Placed& p) {
  v("turn", p.turn, {"x, y, z, w"});
  v("shapes", p.shapes, {{"round", Shape::round}, {"square", Shape::square}}, "of it");
  v.Required("count", p.count, {"number"});
}

TEST(FieldReader, QuaternionsListsOfNamesAndWhatMustBeThere) {
  const auto read = [](const std::string& text, Placed& placed) -> std::string {
    Document document = Document::FromText(text, "f.yaml");
    const bool good = ReadFields(document.root(), placed);
    try {
      document.ThrowIfBad();
    } catch (const Error& error) {
      EXPECT_FALSE(good);
      return error.what();
    }
    EXPECT_TRUE(good);
    return "";
  };
  Placed placed, plain, bad;
  EXPECT_EQ(read("{turn: [0, 0.6, 0, 0.8004], shapes: [square], count: 3}", placed), "");
  EXPECT_NEAR(length(placed.turn), 1, 1e-15);
  EXPECT_THAT(placed.shapes, ElementsAre(Shape::square));
  EXPECT_EQ(read("{count: 3}", plain), "");
  EXPECT_THAT(plain.shapes, ElementsAre(Shape::round));
  EXPECT_EQ(read("{turn: [0, 0, 0, 0.9], shapes: [round, oval]}", bad),
            "f.yaml: missing key 'count'\n"
            "f.yaml:1:8: 'turn': the quaternion's length is 0.9, not 1 (x, y, z, w)\n"
            "f.yaml:1:32: 'shapes': there is no 'oval'; there are round, square");
  FieldRows table;
  Visit(table, plain);
  EXPECT_EQ(table.rows.at(0).value + "|" + table.rows.at(1).value + "|" + table.rows.at(1).range,
            "0, 0, 0, 1|round|round, square");
}

TEST(Problem, OfAValueFromTheCommandLineHasItsKey) {
  Document document = Document::FromText("inner: {side: 4}", "f.yaml");
  document.Override("inner.share", "2");
  document.Override("rays", "[");
  Example example;
  ReadFields(document.root(), example);
  std::vector<std::string> keys;
  try {
    document.ThrowIfBad();
  } catch (const Error& error) {
    for (const Problem& problem : error.problems()) keys.push_back(problem.key);
  }
  EXPECT_THAT(keys, ElementsAre("rays", "rays", "inner.share", ""));
}

}  // namespace
}  // namespace settings
