#include <gmock/gmock.h>

#include "tools/base/settings/settings.h"

namespace settings {
namespace {

using testing::ElementsAre;

std::string Problems(const Document& document) {
  try {
    document.ThrowIfBad();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Override, SetsDeepKeysListItemsAndWholeLists) {
  Document document = Document::FromText("a: {b: 1}\nlist: [{x: 1}, {x: 2}]\nv: [1, 2]\n", "f.yaml");
  document.Override("a.b", "8 ms");
  document.Override("a.new.deep", "3");
  document.Override("list.1.x", "5");
  document.Override("v", "[4, 5, 6]");
  document.Override("a.b", "9 ms");
  Section root = document.root();
  double b = 0, deep = 0;
  std::vector<double> v, xs;
  root.Child("a").Read("b", b, Unit::time);
  root.Child("a").Child("new").Read("deep", deep);
  for (Section& item : root.List("list")) {
    double x = 0;
    item.Read("x", x);
    xs.push_back(x);
  }
  root.Read("v", v);
  EXPECT_EQ(Problems(document), "");
  EXPECT_EQ(b, 0.009) << "the last one wins";
  EXPECT_EQ(deep, 3);
  EXPECT_THAT(xs, ElementsAre(1, 5));
  EXPECT_THAT(v, ElementsAre(4, 5, 6));
}

TEST(Override, ProblemsNameTheCommandLine) {
  Document document = Document::FromText("camera: {width: 640}\nlist: [{x: 1}]\n", "f.yaml");
  document.Override("camera.widht", "3");
  document.Override("camera.width", "three");
  document.Override("camera.height.x", "3");
  document.Override("list.1.x", "3");
  document.Override("list.one", "3");
  document.Override("camera.width.x", "3");
  document.Override("", "3");
  document.Override("a..b", "3");
  document.Override("a.", "3");
  document.Override("bad", "[1, ");
  Section root = document.root();
  int width = 0;
  double x = 0;
  root.Child("camera").Read("width", width);
  for (Section& item : root.List("list")) item.Read("x", x);
  root.Ignore("bad");
  EXPECT_EQ(Problems(document),
            "--set list.1.x: there is no item 1 in a list of 1 (the first is 0)\n"
            "--set list.one: in a list: 'one' is not a whole number of at least 0\n"
            "--set camera.width.x: 'x' cannot be set inside 'three'\n"
            "--set : not a key: expected words with dots between them\n"
            "--set a..b: not a key: expected words with dots between them\n"
            "--set a.: not a key: expected words with dots between them\n"
            "--set bad: not valid YAML: end of sequence flow not found\n"
            "--set camera.width: 'camera.width': 'three' is not a whole number\n"
            "--set camera.widht: unknown key 'widht'; did you mean 'width'?\n"
            "--set camera.height.x: unknown key 'height'; known: width");
}

TEST(Override, IntoAnEmptyFileOrAnEmptySection) {
  Document document = Document::FromText("a:\n", "f.yaml");
  document.Override("a.b", "1");
  document.Override("c.d", "2");
  double b = 0, d = 0;
  document.root().Child("a").Read("b", b);
  document.root().Child("c").Read("d", d);
  EXPECT_EQ(Problems(document), "");
  EXPECT_EQ(b, 1);
  EXPECT_EQ(d, 2);
}

TEST(Override, AfterReadingIsOurBug) {
  Document document = Document::FromText("a: 1\n", "f.yaml");
  document.root();
  EXPECT_THROW(document.Override("a", "2"), std::logic_error);
}

}  // namespace
}  // namespace settings
