// Series of one record per frame with bounded memory: the newest records in memory, older ones in an unnamed file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "tools/base/files.h"

namespace vobench {

// Unnamed file that is removed with this object, however the program ends. Created at the first write. Throws
// std::runtime_error naming the folder and the reason (disk full, no permission).
class SeriesFile {
 public:
  explicit SeriesFile(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void Append(const void* bytes, std::size_t count);
  void Read(std::uint64_t offset, void* bytes, std::size_t count) const;

 private:
  void Open();
  [[noreturn]] void Fail(const char* what, int why) const;

  std::filesystem::path folder_;
  base::Descriptor file_;
};

template <class Record>
class DiskBackedSeries {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  // Records kept in memory; a longer series uses the disk. Without a folder, all are in memory.
  explicit DiskBackedSeries(const std::optional<std::filesystem::path>& folder, std::size_t in_memory = 1024)
      : file_(folder.value_or("")), in_memory_(folder ? in_memory : std::numeric_limits<std::size_t>::max()) {}

  void Add(const Record& record) {
    if (newest_.size() == in_memory_) {
      file_.Append(newest_.data(), newest_.size() * sizeof(Record));
      written_ += newest_.size();
      newest_.clear();
    }
    newest_.push_back(record);
  }

  std::size_t size() const { return written_ + newest_.size(); }

  // In the order in which they came.
  template <class Visit>
  void ForEach(const Visit& visit) const {
    std::vector<Record> block(written_ > 0 ? in_memory_ : 0);
    for (std::size_t k = 0; k < written_; k += in_memory_) {  // what is written is whole blocks
      file_.Read(k * sizeof(Record), block.data(), in_memory_ * sizeof(Record));
      for (const Record& record : block) visit(record);
    }
    for (const Record& record : newest_) visit(record);
  }

 private:
  SeriesFile file_;
  std::size_t in_memory_ = 0, written_ = 0;
  std::vector<Record> newest_;
};

}  // namespace vobench
