// HTTP server on the loopback interface for one page and its data.
//
// It listens on 127.0.0.1 at a free port. Its address has a token of 128 random bits from the system; requests for
// another path or Host are answered 404, methods other than GET 405. SECURITY.md has the limits on connections, their
// time and their memory, and the tests that hold them.
#pragma once

#include <memory>
#include <string>

namespace vobench {

class LiveServer {
 public:
  static constexpr std::size_t kMostConnections = 16;  // more wait in the kernel's queue, and are answered later
  static constexpr std::size_t kMostRequestBytes = 8192;
  static constexpr int kRequestSeconds = 3;  // from the connection to the end of the request
  static constexpr int kAnswerSeconds = 10;  // from then to the end of the answer

  // Throws std::runtime_error where no port can be had.
  LiveServer();
  ~LiveServer();  // no request is answered from now on; waits for no client
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  // "http://127.0.0.1:40123/0f...9c/". The page is there, the data in "data" below it.
  const std::string& address() const { return address_; }

  // Whether there was a valid request since the last Publish.
  bool Asked() const;
  void Publish(std::string page, std::string data);

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
  std::string address_;
};

}  // namespace vobench
