#include "vo/sequence/read_ahead.h"

#include <utility>

namespace vo {

ReadAhead::ReadAhead(FrameSource& source, std::size_t most)
    : source_(source), most_(most), reader_([this] { Read(); }) {}

ReadAhead::~ReadAhead() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  reader_.join();
}

std::optional<PreparedFrame> ReadAhead::Next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !ready_.empty() || ended_; });
  if (ready_.empty()) {
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    return std::nullopt;
  }
  PreparedFrame frame = std::move(ready_.front());
  ready_.pop_front();
  lock.unlock();
  changed_.notify_all();
  return frame;
}

void ReadAhead::Read() {
  const auto end = [this](std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    error_ = std::move(error);
    ended_ = true;
    changed_.notify_all();
  };
  try {
    while (std::optional<Frame> frame = source_.Next()) {
      PreparedFrame prepared(std::move(*frame));
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ready_.size() < most_ || stop_; });
      if (stop_) return;
      ready_.push_back(std::move(prepared));
      changed_.notify_all();
    }
    end(nullptr);
  } catch (...) {
    end(std::current_exception());
  }
}

}  // namespace vo
