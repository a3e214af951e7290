// Writer of a sequence: frame by frame, in parallel, resumable after any interruption.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "sim/sequence/content.h"
#include "sim/sequence/journal.h"
#include "sim/simulator.h"
#include "tools/base/files.h"

namespace sim {

// Usage:  SequenceWriter writer(simulator, folder, content, jobs, SequenceWriter::Start::fresh);
//         while (writer.Wait() > 0) {}      // progress in between
//         writer.Finish();
// The lists, the truth and the manifest of all frames are written first, then the frames, `jobs` of them at the same
// time: one is encoded while another is rendered. Files are written atomically, and the journal lists the complete
// frames. The bytes depend neither on `jobs`, nor on the order of the frames, nor on interruptions; those of a frame
// not on the range.
class SequenceWriter {
 public:
  enum class Start { fresh, resume };

  // `simulator` must outlive the writer. The folder is made; fresh, it must not exist or be empty. To resume, it must
  // be of the same content: complete frames are kept, the rest is made again; an empty one is the same as fresh. Throws
  // std::invalid_argument for a bad content or jobs < 1, and where the folder is not of this content, naming every
  // setting that differs, or the frame whose bytes differ when rendered again (a mesh or texture has changed).
  // std::runtime_error when the folder cannot be made or written, or another process is writing it.
  SequenceWriter(const Simulator& simulator, const std::filesystem::path& folder, const SequenceContent& content,
                 int jobs, Start start);
  ~SequenceWriter();  // Stop, unless finished
  SequenceWriter(const SequenceWriter&) = delete;
  SequenceWriter& operator=(const SequenceWriter&) = delete;

  // Number of frames that were complete at the start: 0 if fresh.
  std::int64_t found() const { return found_; }

  // Waits for newly completed frames and returns their number since the last call; 0: all frames are complete. Throws
  // std::runtime_error naming a file that could not be written, and why.
  std::int64_t Wait();

  // Ends the work. The folder then holds the frames before the first incomplete one, and its lists name exactly these;
  // a folder without a frame is removed, with the parents that were made for it. Returns the number of frames. Needs no
  // disk space and does not throw.
  std::int64_t Stop() noexcept;

  // Call when all frames are complete: the sequence is final but for the journal, to be removed (kJournalName) when the
  // folder has its final name. Throws std::logic_error while frames are left.
  void Finish();

 private:
  void Prepare(Start start);
  void RequireSame(const Journal& whole) const;
  void KeepOnly(std::int64_t whole);
  void RemoveStrays(const std::vector<StreamFile>& lists) const;
  void Write(const StreamFile& file) const;
  void Work();

  const Simulator& simulator_;
  std::filesystem::path folder_;
  SequenceContent content_;
  std::vector<std::filesystem::path> made_;  // the folder and its parents, where they were not there; innermost first
  base::Descriptor lock_;                    // the folder, open
  std::int64_t found_ = 0;
  bool ours_ = false;  // what is in the folder
  bool over_ = false;

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::deque<std::int64_t> left_;
  Journal whole_;
  std::int64_t notified_ = 0;
  bool stop_ = false;
  std::exception_ptr error_;
  std::vector<std::jthread> threads_;
};

}  // namespace sim
