#include "sim/sequence/writer.h"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <system_error>

namespace sim {
namespace fs = std::filesystem;
namespace {

// Whether the folder is empty, or has only a manifest left unfinished by a killed process.
bool IsEmpty(const fs::path& folder) {
  if (!fs::exists(fs::symlink_status(folder))) return true;
  if (!fs::is_directory(folder)) return false;
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), [](const fs::directory_entry& entry) {
    return entry.path().filename() == base::UnfinishedName(kManifestName);
  });
}

}  // namespace

SequenceWriter::SequenceWriter(const Simulator& simulator, const fs::path& folder, const SequenceContent& content,
                               int jobs, Start start)
    : simulator_(simulator), folder_(fs::absolute(folder).lexically_normal()), content_(content) {
  Validate(content_, simulator_);
  if (jobs < 1) throw std::invalid_argument("jobs must be at least 1, not " + std::to_string(jobs));
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  try {
    Prepare(start);
  } catch (...) {
    Stop();
    throw;
  }
  for (std::int64_t index = content_.first; index < content_.last; ++index) {
    if (!whole_.contains(index)) left_.push_back(index);
  }
  found_ = notified_ = static_cast<std::int64_t>(whole_.size());
  const std::size_t count = std::min(static_cast<std::size_t>(jobs), left_.size());
  for (std::size_t i = 0; i < count; ++i) threads_.emplace_back([this] { Work(); });
}

SequenceWriter::~SequenceWriter() { Stop(); }

void SequenceWriter::Prepare(Start start) {
  const bool empty = IsEmpty(folder_);
  if (start == Start::fresh && !empty) {
    throw std::runtime_error(folder_.string() + ": is there already and not an empty folder");
  }
  for (fs::path path = folder_; !fs::exists(path); path = path.parent_path()) made_.push_back(path);
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw std::runtime_error(folder_.string() + ": cannot make this folder: " + error.message());
  lock_ = base::Descriptor(open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock_ && flock(*lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw std::runtime_error(folder_.string() + ": another process is writing it");
  }
  if (!empty) {
    whole_ = ReadJournal(folder_);
    std::erase_if(whole_,
                  [&](const auto& frame) { return frame.first < content_.first || frame.first >= content_.last; });
    RequireSame(whole_);
  }
  ours_ = true;
  // The manifest comes first: it identifies a folder that a killed process leaves behind.
  const std::vector<StreamFile> lists = WholeFiles(simulator_, content_, content_.last - content_.first);
  for (const StreamFile& file : lists) {
    if (file.path == kManifestName) Write(file);
  }
  std::string journal;
  for (const auto& [index, files] : whole_) journal += JournalLine(index, files);
  base::WriteFileAndFolders(folder_ / kJournalName, journal);
  for (const StreamFile& file : lists) Write(file);
  RemoveStrays(lists);
}

// The last frame is rendered once more: the manifest has only the names of meshes, textures and recorded motion.
void SequenceWriter::RequireSame(const Journal& whole) const {
  const fs::path file = folder_ / kManifestName;
  if (!fs::exists(file))
    throw std::invalid_argument(file.string() + ": is not there, so this is no sequence to resume");
  std::vector<std::string> differences;
  try {
    differences = ManifestDifferences(base::ReadFile(file).value_or(""), Manifest(simulator_, content_, 0));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(file.string() + ": " + error.what() + "; remove the folder to start anew");
  }
  if (!differences.empty()) {
    std::string text = folder_.string() + ": holds another sequence, which cannot be resumed as this one:";
    for (const std::string& difference : differences) text += "\n  " + difference;
    throw std::invalid_argument(text);
  }
  if (whole.empty()) return;
  const auto& [index, files] = *whole.rbegin();
  const std::vector<JournalFile> again = Summed(FrameFiles(simulator_, content_, index));
  for (std::size_t i = 0; i < std::max(files.size(), again.size()); ++i) {
    if (i < files.size() && i < again.size() && files[i] == again[i]) continue;
    throw std::invalid_argument((folder_ / (i < files.size() ? files[i] : again[i]).path).string() +
                                ": does not come out the same again: a file that the scenario names (mesh, texture, "
                                "trajectory) has changed, or the program; remove the folder to start anew");
  }
}

// Removes all but the lists, the journal and the complete frames. All content belongs to this sequence: its manifest
// does.
void SequenceWriter::RemoveStrays(const std::vector<StreamFile>& lists) const {
  std::set<fs::path> kept = {folder_ / kJournalName};
  for (const StreamFile& file : lists) kept.insert(folder_ / file.path);
  for (const auto& [index, files] : whole_) {
    for (const JournalFile& file : files) kept.insert(folder_ / file.path);
  }
  std::vector<fs::path> strays;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
    if (!entry.is_directory() && !kept.contains(entry.path())) strays.push_back(entry.path());
  }
  std::error_code ignored;
  for (const fs::path& stray : strays) fs::remove(stray, ignored);
}

void SequenceWriter::Write(const StreamFile& file) const {
  base::WriteFileAndFolders(folder_ / file.path, base::AsText(file.bytes));
}

void SequenceWriter::Work() {
  for (;;) {
    std::int64_t index = 0;
    {
      const std::lock_guard lock(mutex_);
      if (stop_ || left_.empty()) return;
      index = left_.front();
      left_.pop_front();
    }
    try {
      const std::vector<StreamFile> files = FrameFiles(simulator_, content_, index);
      for (const StreamFile& file : files) Write(file);
      const std::vector<JournalFile> summed = Summed(files);
      const std::lock_guard lock(mutex_);
      base::AppendToFile(folder_ / kJournalName, JournalLine(index, summed));
      whole_[index] = summed;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stop_ = true;
    }
    changed_.notify_one();
  }
}

std::int64_t SequenceWriter::Wait() {
  std::unique_lock lock(mutex_);
  const auto whole = [&] { return static_cast<std::int64_t>(whole_.size()); };
  changed_.wait(lock, [&] { return error_ || whole() > notified_ || whole() == content_.last - content_.first; });
  if (error_) std::rethrow_exception(error_);
  const std::int64_t more = whole() - notified_;
  notified_ = whole();
  return more;
}

std::int64_t SequenceWriter::Stop() noexcept {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  threads_.clear();  // joins
  std::int64_t whole = 0;
  while (whole_.contains(content_.first + whole)) ++whole;
  if (over_) return whole;
  over_ = true;
  try {
    KeepOnly(whole);
  } catch (...) {
    // The folder is in the state that a killed process leaves: resuming repairs it.
  }
  lock_.Close();
  return whole;
}

void SequenceWriter::KeepOnly(std::int64_t whole) {
  if (whole == content_.last - content_.first) return;
  if (whole == 0) {
    if (ours_) fs::remove_all(folder_);
    std::error_code not_empty;
    for (const fs::path& path : made_) fs::remove(path, not_empty);
    return;
  }
  if (!ours_) return;
  whole_.erase(whole_.lower_bound(content_.first + whole), whole_.end());
  const std::vector<StreamFile> lists = WholeFiles(simulator_, content_, whole);
  RemoveStrays(lists);
  for (const StreamFile& file : lists) base::ShortenFile(folder_ / file.path, base::AsText(file.bytes));
}

void SequenceWriter::Finish() {
  if (static_cast<std::int64_t>(whole_.size()) != content_.last - content_.first) {
    throw std::logic_error("SequenceWriter::Finish: frames are left to be written");
  }
  Stop();
}

}  // namespace sim
