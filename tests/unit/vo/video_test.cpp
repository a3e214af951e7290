// Frames of videos: all of a file's, and the newest one of a camera, here a network camera over HTTP.
#include "vo/sequence/video.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <thread>

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Frame k, of uniform brightness.
cv::Mat Picture(int k) { return {48, 64, CV_8UC3, cv::Scalar::all(8 * (k % 30))}; }

std::string ErrorOf(const std::string& what) {
  try {
    vo::OpenFrames(what);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(VideoFile, GivesEveryFrameWithItsTime) {
  const fs::path file = fs::path(testing::TempDir()) / "video_test.mp4";
  {
    cv::VideoWriter writer(file.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 25, {64, 48});
    ASSERT_TRUE(writer.isOpened());
    for (int k = 0; k < 30; ++k) writer.write(Picture(k));
  }
  const std::unique_ptr<vo::FrameSource> source = vo::OpenFrames(file.string());
  EXPECT_EQ(source->Count(), 30);
  for (int k = 0; k < 30; ++k) {
    const std::optional<vo::Frame> frame = source->Next();
    ASSERT_TRUE(frame) << k;
    EXPECT_EQ(frame->stamp_ns, k * std::int64_t{40'000'000});
    EXPECT_EQ(frame->image.type(), CV_8UC3);
    EXPECT_NEAR(cv::mean(frame->image)[1], 8 * k, 3.9) << "frame " << k;  // less than half a step
  }
  EXPECT_FALSE(source->Next());
  fs::remove(file);
}

TEST(VideoFile, WhatCannotBeOpenedIsNamed) {
  EXPECT_THAT(ErrorOf("/nowhere/a.mp4"), HasSubstr("/nowhere/a.mp4: no such folder or file"));
  EXPECT_THAT(ErrorOf("/proc/self/exe"), HasSubstr("is neither a sequence's folder nor a video"));
  EXPECT_THAT(ErrorOf("camera:front"), HasSubstr("camera:front: a camera is 'camera:' and its number"));
  EXPECT_THAT(ErrorOf("camera:99"), HasSubstr("camera:99: no pictures come from there"));
}

// Motion JPEG server on the loopback interface: one client, a picture each 10 ms, `pictures` in all.
class MotionJpegCamera {
 public:
  explicit MotionJpegCamera(int pictures) : pictures_(pictures) {
    socket_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(socket_, 1) != 0)
      throw std::runtime_error("no socket");
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    address_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/video.mjpg";
    sender_ = std::thread([this] { Send(); });
  }
  ~MotionJpegCamera() {
    shutdown(socket_, SHUT_RDWR);  // ends accept() without a client
    sender_.join();
    close(socket_);
  }
  const std::string& address() const { return address_; }
  int sent() const { return sent_; }

 private:
  void Send() {
    const int client = accept(socket_, nullptr, nullptr);
    if (client < 0) return;
    char request[4096];
    if (read(client, request, sizeof request) <= 0) return;
    const auto write = [&](const void* data, std::size_t n) {
      return send(client, data, n, MSG_NOSIGNAL) == static_cast<ssize_t>(n);
    };
    const std::string head = "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace;boundary=next\r\n\r\n";
    bool good = write(head.data(), head.size());
    for (int k = 0; good && k < pictures_; ++k) {
      std::vector<std::uint8_t> jpeg;
      cv::imencode(".jpg", Picture(k), jpeg);
      const std::string part =
          "--next\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) + "\r\n\r\n";
      good = write(part.data(), part.size()) && write(jpeg.data(), jpeg.size()) && write("\r\n", 2);
      ++sent_;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    close(client);
  }

  int pictures_;
  int socket_ = -1;
  std::string address_;
  std::atomic<int> sent_ = 0;
  std::thread sender_;
};

TEST(LiveCamera, GivesTheNewestFrameAndCountsTheOthers) {
  MotionJpegCamera camera(120);
  const std::unique_ptr<vo::FrameSource> source = vo::OpenFrames(camera.address());
  EXPECT_FALSE(source->Count());
  std::int64_t last_ns = -1, taken = 0;
  while (const std::optional<vo::Frame> frame = source->Next()) {
    EXPECT_GT(frame->stamp_ns, last_ns);
    last_ns = frame->stamp_ns;
    ++taken;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // slower than the camera
  }
  EXPECT_GT(taken, 2);
  EXPECT_LT(taken, 60);
  EXPECT_LE(taken + source->Dropped(), camera.sent());
  EXPECT_GE(taken + source->Dropped(), camera.sent() - 5) << "what FFmpeg keeps for itself";
  EXPECT_GT(source->Dropped(), taken);
}

}  // namespace
