// Purpose: a page and its data for browsers on this machine, and nobody else.
//
// It listens on 127.0.0.1 alone, at a port that is free. Its address has a token of 128 random bits from the system,
// and what does not ask by that address and name is answered 404; anything but GET is 405: there is nothing to write.
// Whoever connects can neither slow the work nor hold up its end nor fill the memory: SECURITY.md has the limits and
// the tests that hold them.
#pragma once

#include <memory>
#include <string>

namespace vobench {

class LiveServer {
 public:
  static constexpr std::size_t kMostConnections = 16;  // more wait in the kernel's queue, and are answered later
  static constexpr std::size_t kMostRequestBytes = 8192;
  static constexpr int kRequestSeconds = 3;  // that a client has to say what it wants, ...
  static constexpr int kAnswerSeconds = 10;  // ... and to take the answer

  // Throws std::runtime_error where no port can be had.
  LiveServer();
  ~LiveServer();  // from now on nobody answers; waits for no client
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  // "http://127.0.0.1:40123/0f...9c/". The page is there, the data in "data" below it.
  const std::string& address() const { return address_; }

  // Whether somebody who may has asked since the last Publish.
  bool Asked() const;
  void Publish(std::string page, std::string data);

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
  std::string address_;
};

}  // namespace vobench
