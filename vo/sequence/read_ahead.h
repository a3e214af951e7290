// Purpose: the first stage of the pipeline in a thread of its own: while one frame is tracked the next ones are read, decoded and prepared.
//          What comes out is the same as without it, in the same order.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "vo/base/source.h"
#include "vo/frontend/prepared_frame.h"

namespace vo {

class ReadAhead {
 public:
  // No more than `most` frames are waiting at a time. `source` is this object's alone as long as it lives.
  explicit ReadAhead(FrameSource& source, std::size_t most = 2);
  ~ReadAhead();  // does not wait for frames that nobody asked for, but for the one being read
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  // The next frame, or none after the last. Throws what the source threw, after the frames before it.
  std::optional<PreparedFrame> Next();

 private:
  void Read();

  FrameSource& source_;
  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<PreparedFrame> ready_;
  std::exception_ptr error_;
  bool ended_ = false, stop_ = false;
  std::thread reader_;
};

}  // namespace vo
