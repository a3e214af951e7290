#include "tools/bench/tracking/map_file.h"

#include <assimp/scene.h>
#include <gmock/gmock.h>

#include <assimp/Importer.hpp>
#include <map>
#include <sstream>

#include "tools/bench/errors.h"

namespace vobench {
namespace {

std::vector<vo::MapPoint> SomePoints() {
  vo::MapPoint known{7, {1, 2, 3}, 0.5, 0.01, true, 0.02, vo::PointMoments{{1.5, -2.25, 3}, {}}};
  known.moments->covariance << 4, 1, 2, 1, 5, 3, 2, 3, 6;
  vo::MapPoint vague{8, {9, 9, 9}, -0.1, 0.2, false, INFINITY, std::nullopt};
  vo::MapPoint other = known;
  other.id = 9;
  other.permanent = false;
  return {known, vague, other};
}

// Reader of the format: columns by the header's names.
std::vector<std::map<std::string, double>> Read(const std::string& text) {
  std::istringstream stream(text);
  std::string line, word;
  std::vector<std::string> columns;
  std::size_t vertices = 0;
  std::getline(stream, line);
  EXPECT_EQ(line, "ply");
  std::getline(stream, line);
  EXPECT_EQ(line, "format ascii 1.0");
  while (std::getline(stream, line) && line != "end_header") {
    std::istringstream words(line);
    words >> word;
    if (word == "element") words >> word >> vertices;
    if (word == "property") {
      words >> word >> word;
      columns.push_back(word);
    }
  }
  std::vector<std::map<std::string, double>> points(vertices);
  for (auto& point : points) {
    std::getline(stream, line);
    std::istringstream words(line);
    for (const std::string& column : columns) words >> point[column];
    EXPECT_FALSE(words.fail()) << line;
    EXPECT_FALSE(words >> word) << "more columns than the header has";
  }
  EXPECT_FALSE(std::getline(stream, line)) << "more lines than the header has";
  return points;
}

TEST(MapFile, HoldsMeanCovarianceAndWhatIsKnownOfTheDepth) {
  const auto points = Read(MapText(SomePoints()));
  ASSERT_EQ(points.size(), 2u);
  const std::map<std::string, double> expected = {{"x", 1.5},
                                                  {"y", -2.25},
                                                  {"z", 3},
                                                  {"red", 30},
                                                  {"green", 110},
                                                  {"blue", 200},
                                                  {"cov_xx", 4},
                                                  {"cov_xy", 1},
                                                  {"cov_xz", 2},
                                                  {"cov_yy", 5},
                                                  {"cov_yz", 3},
                                                  {"cov_zz", 6},
                                                  {"id", 7},
                                                  {"permanent", 1},
                                                  {"inverse_depth", 0.5},
                                                  {"inverse_depth_sigma", 0.01},
                                                  {"relative_sigma", 0.02}};
  EXPECT_EQ(points[0], expected);
  EXPECT_EQ(points[1].at("id"), 9);
  EXPECT_EQ(points[1].at("permanent"), 0);
  EXPECT_THAT(MapText(SomePoints()), testing::HasSubstr("comment 1 more landmarks are left out"));
  EXPECT_TRUE(Read(MapText({})).empty());
}

TEST(MapFile, HoldsIdsOfAnySize) {
  std::vector<vo::MapPoint> points = SomePoints();
  EXPECT_THAT(MapText(points), testing::HasSubstr("property int id\n"));
  points[2].id = 5'000'000'000;
  EXPECT_THAT(MapText(points), testing::HasSubstr("property double id\n"));
  EXPECT_EQ(Read(MapText(points))[1].at("id"), 5'000'000'000);
}

TEST(MapFile, IsReadByAssimp) {
  const std::string text = MapText(SomePoints());
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(), 0, "ply");
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  ASSERT_EQ(scene->mMeshes[0]->mNumVertices, 2u);
  const aiVector3D& X = scene->mMeshes[0]->mVertices[0];
  EXPECT_EQ(X.x, 1.5f);
  EXPECT_EQ(X.y, -2.25f);
  EXPECT_EQ(X.z, 3.0f);
}

TEST(MapFile, PathsAreCheckedBeforeTheWork) {
  EXPECT_NO_THROW(RequireMapPath("map.ply", std::nullopt));
  EXPECT_NO_THROW(RequireMapPath("map.ply", "out"));
  EXPECT_THROW(RequireMapPath("map.txt", "out"), BadInput);
  EXPECT_THROW(RequireMapPath("no/such/folder/map.ply", "out"), BadInput);
  const RunEntry run{"rb2pf", 3, ".", 0};
  EXPECT_EQ(MapPathOf("out/map.ply", run, false), "out/map.ply");
  EXPECT_EQ(MapPathOf("out/map.ply", run, true), "out/map_rb2pf_seed_3.ply");
}

// A map inside the result's folder, which the result replaces, is refused.
TEST(MapFile, IsNotPutWhereTheResultReplacesIt) {
  const std::filesystem::path here = std::filesystem::path(testing::TempDir()) / "map_file_test";
  std::filesystem::create_directories(here / "out/inner");
  for (const char* map : {"out/map.ply", "out/../out/map.ply", "out/inner/map.ply"}) {
    EXPECT_THROW(RequireMapPath(here / map, here / "out"), BadInput) << map;
    EXPECT_THROW(RequireMapPath(here / map, here / "out/"), BadInput) << map;
    EXPECT_NO_THROW(RequireMapPath(here / map, here / "ou")) << map;
    EXPECT_NO_THROW(RequireMapPath(here / map, here / "other/out")) << map;
  }
  EXPECT_NO_THROW(RequireMapPath(here / "map.ply", here / "out"));
  std::filesystem::remove_all(here);
}

}  // namespace
}  // namespace vobench
