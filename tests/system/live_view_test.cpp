// While strangers flood its server, a run goes on, and its results are those of a run that nobody could look at.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <regex>
#include <set>
#include <thread>
#include <vector>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;

// Connects, says something and hangs up, as often as it can, until told otherwise. How often that was.
int Flood(int port, const std::string& words, const std::atomic<bool>& enough) {
  int times = 0;
  while (!enough) {
    const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{0, 100'000};
    setsockopt(file, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    if (connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
      times += send(file, words.data(), words.size(), MSG_NOSIGNAL) > 0;
    }
    close(file);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return times;
}

TEST(LiveViewTest, AFloodOfStrangersChangesNothing) {
  const TemporaryFolder here;
  const auto words = [](const std::string& out) {
    return std::vector<std::string>{"run",   TinyScenario().string(), "-o",    out,
                                    "--set", "time.rate=120 Hz",      "--set", "sensor.exposure=1 ms"};
  };
  ASSERT_EQ(RunVobench(words("alone"), here.path()).status, 0);
  std::atomic<bool> enough = false;
  std::vector<std::thread> strangers;
  std::atomic<int> times = 0;
  std::thread watch([&] {
    const std::regex address("View: http://127\\.0\\.0\\.1:(\\d+)/");
    std::smatch found;
    std::string said;
    while (!enough && !std::regex_search(said, found, address)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (fs::exists(here / "said.txt")) said = ReadFile(here / "said.txt");
    }
    if (enough) return;
    const int port = std::stoi(found[1]);
    for (const std::string& talk : {std::string("G"), "GET / HTTP/1.1\r\nHost: x\r\n\r\n" + std::string(100'000, 'x'),
                                    std::string(1 << 20, 'a')}) {
      strangers.emplace_back([&times, &enough, port, talk] { times += Flood(port, talk, enough); });
    }
  });
  auto viewed = words("viewed");
  viewed.push_back("--view");
  const Outcome outcome = RunVobench(viewed, here.path(), "exec 2> said.txt");
  enough = true;
  watch.join();
  for (std::thread& stranger : strangers) stranger.join();
  EXPECT_EQ(outcome.status, 0) << ReadFile(here / "said.txt");
  EXPECT_GT(times, 20);
  // What has the command line or the time that it took in it.
  const std::set<std::string> changing = {"run.json", "metrics.json", "report.html", "frames.csv"};
  const auto alone = Tree(here / "alone");
  auto there = Tree(here / "viewed");
  EXPECT_EQ(there.size(), alone.size());
  for (const auto& [name, bytes] : alone) {
    const bool is_compared = !changing.contains(fs::path(name).filename().string());
    EXPECT_TRUE(!is_compared || there[name] == bytes) << name;
  }
}

}  // namespace
}  // namespace vobench::system_test
