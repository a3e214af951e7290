#include "tools/bench/result/output_folder.h"

#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "tests/temporary_folder.h"
#include "tools/bench/errors.h"

namespace vobench {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kMarker = "run.json";
const std::set<std::string> kOurs = {"run.json", "report.html", "frames"};

class OutputFolderTest : public testing::Test {
 protected:
  static void Write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  static std::string Read(const fs::path& file) {
    std::string line;
    std::ifstream stream(file);
    std::getline(stream, line);
    return line;
  }
  std::size_t EntriesHere() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(here_), fs::directory_iterator()));
  }
  std::string Refusal(const fs::path& folder) const {
    try {
      const OutputFolder out(folder, kMarker, kOurs);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "accepted";
  }

  const vobench_test::TemporaryFolder folder_;
  const fs::path here_ = folder_.path();
};

TEST_F(OutputFolderTest, AppearsOnlyWhenCommitted) {
  OutputFolder out(here_ / "a", kMarker, kOurs);
  Write(out.path() / "run.json", "new");
  EXPECT_FALSE(fs::exists(here_ / "a"));
  out.Commit();
  EXPECT_EQ(Read(here_ / "a" / "run.json"), "new");
  EXPECT_EQ(EntriesHere(), 1U);
}

TEST_F(OutputFolderTest, LeavesNothingWhenTheWorkStops) {
  {
    const OutputFolder out(here_ / "deep" / "deeper" / "a", kMarker, kOurs);
    Write(out.path() / "frames" / "1.jpg", "half");
  }
  EXPECT_EQ(EntriesHere(), 0U) << "the parents it made go too";
}

TEST_F(OutputFolderTest, KeepsTheOldResultUntilTheNewOneIsWhole) {
  Write(here_ / "a" / "run.json", "old");
  Write(here_ / "a" / "report.html", "old");
  {
    const OutputFolder out(here_ / "a", kMarker, kOurs);
    Write(out.path() / "run.json", "new");
  }
  EXPECT_EQ(Read(here_ / "a" / "run.json"), "old");
  OutputFolder out(here_ / "a" / "", kMarker, kOurs);
  Write(out.path() / "run.json", "new");
  out.Commit();
  EXPECT_EQ(Read(here_ / "a" / "run.json"), "new");
  EXPECT_FALSE(fs::exists(here_ / "a" / "report.html")) << "replaced, not merged";
  EXPECT_EQ(EntriesHere(), 1U);
}

TEST_F(OutputFolderTest, RefusesWhatIsNotOurs) {
  Write(here_ / "photos" / "cat.jpg", "cat");
  Write(here_ / "mixed" / "run.json", "old");
  Write(here_ / "mixed" / "thesis.tex", "years of work");
  Write(here_ / "file", "text");
  EXPECT_THAT(Refusal(here_ / "photos"), HasSubstr("photos: is there already"));
  EXPECT_THAT(Refusal(here_ / "mixed"), HasSubstr("thesis.tex"));
  fs::create_symlink("nowhere/out", here_ / "link");
  EXPECT_THAT(Refusal(here_ / "file"), HasSubstr("is no folder"));
  EXPECT_THAT(Refusal(here_ / "link"), HasSubstr("link: is a link to nowhere/out, which is not there"));
  EXPECT_EQ(Read(here_ / "mixed" / "thesis.tex"), "years of work");
  EXPECT_EQ(EntriesHere(), 4U);
}

TEST_F(OutputFolderTest, AnEmptyFolderMayBeReplaced) {
  fs::create_directory(here_ / "a");
  OutputFolder out(here_ / "a", kMarker, kOurs);
  Write(out.path() / "run.json", "new");
  out.Commit();
  EXPECT_EQ(Read(here_ / "a" / "run.json"), "new");
}

TEST_F(OutputFolderTest, AFileAmongTheParentsIsNamed) {
  Write(here_ / "file", "text");
  try {
    const OutputFolder out(here_ / "file" / "a", kMarker, kOurs);
    FAIL() << "made a folder below a file";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("file/a"));
  }
  EXPECT_EQ(EntriesHere(), 1U);
}

}  // namespace
}  // namespace vobench
