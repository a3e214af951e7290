// Resume of a rendering after a kill, an interrupt or a full disk: the frames left are usable, and the resumed run ends
// with the same bytes as an uninterrupted one.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <thread>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
constexpr std::size_t kComments = 3;  // comment lines of rgb.txt
namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::HasSubstr;

class ResumeTest : public testing::Test {
 protected:
  static std::vector<std::string> Render(const std::string& output, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"render", TinyScenario().string(), "-o", output, "--jobs", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  Outcome Run(const std::string& output, const std::vector<std::string>& more = {}) {
    return RunVobench(Render(output, more), here_.path());
  }

  bool Killed(const std::vector<std::string>& arguments, const std::function<bool()>& now) {
    return KillVobench(arguments, here_.path(), now);
  }

  // Number of images in a folder, at any depth, partial ones included.
  std::size_t Pictures(const std::string& folder) const {
    std::size_t count = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(here_ / folder, error), end; !error && entry != end;
         entry.increment(error)) {
      count += entry->path().string().find(".png") != std::string::npos;
    }
    return count;
  }

  TemporaryFolder here_;
};

TEST_F(ResumeTest, KilledAgainAndAgainItEndsWithTheSameBytes) {
  for (const std::string format : {"tum", "euroc"}) {
    const std::string whole = "whole_" + format, seq = "seq_" + format, partial = seq + ".partial";
    const auto started = std::chrono::steady_clock::now();
    ASSERT_EQ(Run(whole, {"--format", format}).status, 0);
    const double all_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count();
    const auto expected = Tree(here_ / whole);
    // Random moments, by time (also during the start of the program) and by number of images; printed on failure.
    std::mt19937 random(std::random_device{}());
    const auto draw = [&](int largest) { return std::uniform_int_distribution<>(0, largest)(random); };
    std::string moments;
    int kills = 0;
    for (int n = 0; n < 6 && !fs::exists(here_ / seq); ++n) {
      const auto begin = std::chrono::steady_clock::now();
      const auto after = milliseconds(draw(static_cast<int>(all_ms / 10)));
      const auto pictures = Pictures(partial) + static_cast<std::size_t>(1 + draw(4));
      moments += n % 2 != 0 ? std::to_string(after.count()) + " ms, " : std::to_string(pictures) + " pictures, ";
      kills += Killed(Render(seq, {"--format", format, "--resume"}), [&] {
        return n % 2 != 0 ? std::chrono::steady_clock::now() - begin >= after : Pictures(partial) >= pictures;
      });
    }
    SCOPED_TRACE(format + ", killed after " + moments + "of " + std::to_string(all_ms) + " ms");
    EXPECT_GT(kills, 1);
    EXPECT_FALSE(fs::exists(here_ / seq) && fs::exists(here_ / partial));
    // Both kinds of damage by a loss of power: truncated files and temporary files.
    if (fs::exists(here_ / partial / "rgb") && !fs::is_empty(here_ / partial / "rgb")) {
      const auto frames = Tree(here_ / partial / "rgb");
      fs::resize_file(here_ / partial / "rgb" / frames.rbegin()->first, 50);
      WriteFile(here_ / partial / "rgb" / ".0.9.png.part", "half a frame");
    }
    const Outcome outcome = Run(seq, {"--format", format, "--resume"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(Tree(here_ / seq) == expected);
    EXPECT_FALSE(fs::exists(here_ / partial));
  }
}

TEST_F(ResumeTest, AWholeSequenceIsLeftAlone) {
  ASSERT_EQ(Run("seq", {"--frames", "0:4"}).status, 0);
  const auto before = Tree(here_.path());
  const auto time = fs::last_write_time(here_ / "seq" / "rgb.txt");
  const Outcome again = Run("seq", {"--frames", "0:4", "--resume"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("4 frames in seq, which was whole"));
  EXPECT_EQ(fs::last_write_time(here_ / "seq" / "rgb.txt"), time);
  const Outcome other = Run("seq", {"--frames", "0:4", "--resume", "--set", "sensor.exposure=2 ms"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("another sequence"));
  EXPECT_THAT(other.err, HasSubstr("scenario.sensor.exposure is 0.01 there, not 0.002"));
  EXPECT_TRUE(Tree(here_.path()) == before);
}

TEST_F(ResumeTest, InterruptedRun) {
  const std::string endless = "time.duration=1000 s";
  const std::string motion =
      "trajectory={type: sampled, start: {position: [2.5, 1.4, 2], look_at: [3, 1.2, 0]}, "
      "position_noise: 0.1, orientation_noise: 0.1, position_return: 1 1/s}";
  const auto arguments = Render("out", {"--set", endless, "--set", motion});
  const Outcome outcome = RunVobench(arguments, here_.path(), "exec timeout -s INT 2 \\");
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("out.partial"), HasSubstr("--resume")));
  EXPECT_FALSE(fs::exists(here_ / "out"));
  // The partial sequence is usable as it is.
  const auto listed = ReadFile(here_ / "out.partial" / "rgb.txt");
  const auto lines = static_cast<std::size_t>(std::count(listed.begin(), listed.end(), '\n')) - kComments;
  EXPECT_EQ(Tree(here_ / "out.partial" / "rgb").size(), lines);
  EXPECT_EQ(Tree(here_ / "out.partial" / "depth").size(), lines);
  EXPECT_EQ(RunVobench({"track", "out.partial", "-o", "tracked"}, here_.path()).status, 0);
  // A temporary file of a killed run belongs to the sequence.
  WriteFile(here_ / "out.partial" / ".velocity.txt.part", "1");
  // Neither the same command nor another scenario overwrites the partial sequence.
  const auto before = Tree(here_.path());
  const Outcome again = RunVobench(arguments, here_.path());
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("--resume"));
  const Outcome other = Run("out", {"--resume", "--seed", "5"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("seed is 1 there, not 5"));
  EXPECT_TRUE(Tree(here_.path()) == before);
  WriteFile(here_ / "out.partial" / "notes.txt", "mine");
  EXPECT_THAT(RunVobench(Render("out", {"--set", endless, "--set", motion, "--resume"}), here_.path()).err,
              HasSubstr("notes.txt"));
}

// Disk that is full after some frames and is then enlarged.
TEST_F(ResumeTest, AFullDiskLeavesThePrefixAndResumes) {
  if (std::system("unshare -rm sh -c 'mount -t tmpfs none /tmp' > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no disk of a given size can be mounted here";
  }
  ASSERT_EQ(Run("whole").status, 0);
  std::string render = Quoted(Program());
  for (const std::string& argument : Render("disk/seq")) render += " " + Quoted(argument);
  const std::string inner = "mount -t tmpfs -o size=500k none disk\n" + render +
                            "\necho STATUS $?\ncp -r disk/seq.partial prefix && " + Quoted(Program()) +
                            " track prefix -o tracked > /dev/null && echo TRACKED\n"
                            "mount -o remount,size=50m disk\n" +
                            render + " --resume && cp -r disk/seq resumed\n";
  const Outcome outcome = RunVobench({}, here_.path(), "mkdir disk; exec unshare -rm sh -c " + Quoted(inner) + "\n");
  EXPECT_THAT(outcome.out, HasSubstr("STATUS 1\n")) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("TRACKED")) << "the odometry runs on what is left\n" << outcome.err;
  EXPECT_THAT(outcome.err, testing::ContainsRegex("disk/seq.partial/.*: cannot be written: No space left on device"));
  EXPECT_THAT(outcome.err, HasSubstr("frames are in "));
  const auto prefix = Tree(here_ / "prefix"), whole = Tree(here_ / "whole");
  const std::string listed = prefix.at("rgb.txt");
  const auto frames = static_cast<std::size_t>(std::count(listed.begin(), listed.end(), '\n')) - kComments;
  EXPECT_GT(frames, 0u);
  EXPECT_LT(frames, 30u);
  for (const std::string list : {"rgb.txt", "depth.txt", "groundtruth.txt", "velocity.txt"}) {
    EXPECT_EQ(whole.at(list).find(prefix.at(list)), 0u) << list << " is the beginning of the whole's";
    EXPECT_EQ(static_cast<std::size_t>(std::count(prefix.at(list).begin(), prefix.at(list).end(), '\n')),
              frames + (list == "rgb.txt" ? kComments : 1));
  }
  EXPECT_EQ(prefix.size(), 2 + 7 + 2 * frames) << "two folders, lists, camera, manifest, journal, and these frames";
  for (const auto& [name, bytes] : prefix) {
    if (!name.ends_with(".png")) continue;
    EXPECT_TRUE(whole.at(name) == bytes) << name;
  }
  EXPECT_TRUE(Tree(here_ / "resumed") == whole);
}

TEST_F(ResumeTest, PreviewsAreMadeAlso) {
  ASSERT_EQ(Run("seq", {"--frames", "0:5", "--preview"}).status, 0);
  EXPECT_GT(fs::file_size(here_ / "seq" / "preview.mp4"), 1000u);
  EXPECT_GT(fs::file_size(here_ / "seq" / "contact.jpg"), 1000u);
  // Preview of a finished sequence; the frames stay as they are.
  ASSERT_EQ(Run("plain", {"--frames", "0:5"}).status, 0);
  auto before = Tree(here_ / "plain");
  ASSERT_EQ(Run("plain", {"--frames", "0:5", "--resume", "--preview"}).status, 0);
  auto after = Tree(here_ / "plain");
  EXPECT_EQ(after.erase("preview.mp4") + after.erase("contact.jpg"), 2u);
  EXPECT_TRUE(before == after);
}

}  // namespace
}  // namespace vobench::system_test
