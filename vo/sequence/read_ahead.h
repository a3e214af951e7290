// Read-ahead: the next frames are read, decoded and prepared in a thread of their own while one is tracked. Frames and
// their order are the same as without it.
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
  // At most `most` frames wait at a time. `source` is used by this object alone during its lifetime.
  explicit ReadAhead(FrameSource& source, std::size_t most = 2);
  ~ReadAhead();  // waits for the frame that is being read, not for further ones
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
