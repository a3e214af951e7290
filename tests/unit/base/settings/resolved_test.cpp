#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tools/base/settings/settings.h"

namespace settings {
namespace {

struct Values {
  double d = 0;
  std::uint64_t u = 0;
  bool b = false;
  std::string s = "x";
  std::vector<double> v;
  std::vector<double> list;

  bool operator==(const Values&) const = default;
};

Values Read(Document document, Values values) {
  Section root = document.root();
  root.Child("section").Read("d", values.d, Unit::time);
  root.Read("u", values.u);
  root.Read("b", values.b);
  root.Read("s", values.s);
  root.Child("section").Child("deeper").Read("v", values.v);
  std::vector<double> list;
  for (Section& item : root.List("list")) {
    double x = 0;
    item.Read("x", x);
    list.push_back(x);
  }
  if (!list.empty()) values.list = list;
  document.ThrowIfBad();
  return values;
}

TEST(Resolved, HoldsDefaultsInSiAndNoIgnoredSection) {
  Document document = Document::FromText("time: {exposure: 8 ms}\nother: 1\nlist: [{x: 1}, {}]\n", "f.yaml");
  Section root = document.root();
  double exposure = 0, rate = 30;
  std::string name = "a \"b\"\n";
  root.Child("time").Read("exposure", exposure, Unit::time);
  root.Child("time").Read("rate", rate, Unit::frequency);
  root.Read("name", name);
  for (Section& item : root.List("list")) {
    double x = 7;
    item.Read("x", x);
  }
  root.Ignore("other");
  EXPECT_EQ(document.Resolved(),
            "{\n"
            "  \"time\": {\n"
            "    \"exposure\": 0.008,\n"
            "    \"rate\": 30\n"
            "  },\n"
            "  \"name\": \"a \\\"b\\\"\\u000a\",\n"
            "  \"list\": [\n"
            "    {\n"
            "      \"x\": 1\n"
            "    },\n"
            "    {\n"
            "      \"x\": 7\n"
            "    }\n"
            "  ]\n"
            "}");
}

TEST(Resolved, ReadAgainGivesTheSameSettings) {
  EXPECT_TRUE(rc::check([] {
    Values values;
    const auto number = [] {
      return static_cast<double>(*rc::gen::arbitrary<std::int32_t>()) * std::pow(10.0, *rc::gen::inRange(-20, 20)) / 7;
    };
    values.d = number();
    values.u = *rc::gen::arbitrary<std::uint64_t>();
    values.b = *rc::gen::arbitrary<bool>();
    values.s = *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127)));
    for (int i = *rc::gen::inRange(0, 4); i > 0; --i) values.v.push_back(number());
    // The defaults are written out ...
    Document document = Document::FromText("", "f.yaml");
    Values defaults = values;
    Section root = document.root();
    root.Child("section").Read("d", defaults.d, Unit::time);
    root.Read("u", defaults.u);
    root.Read("b", defaults.b);
    root.Read("s", defaults.s);
    root.Child("section").Child("deeper").Read("v", defaults.v);
    // ... and override other defaults when they are read.
    RC_ASSERT(Read(Document::FromText(document.Resolved(), "resolved"), Values{}) == values);
  }));
}

}  // namespace
}  // namespace settings
