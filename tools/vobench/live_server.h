// Purpose: a page and its data for browsers on this machine, and nobody else.
//
// It listens on 127.0.0.1 alone, at a port that is free. Its address has a token of 128 random bits from the system, and what
// does not ask by that address and name is answered 404; anything but GET is 405: there is nothing to write.
#pragma once

#include <memory>
#include <string>

namespace vobench {

class LiveServer {
 public:
  // Throws std::runtime_error where no port can be had.
  LiveServer();
  ~LiveServer();  // from now on nobody answers
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  // "http://127.0.0.1:40123/0f...9c/". The page is there, the data in "data" below it.
  const std::string& address() const { return address_; }

  // Whether somebody has asked since the last Publish.
  bool Asked() const;
  void Publish(std::string page, std::string data);

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::string address_;
};

}  // namespace vobench
