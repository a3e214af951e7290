#include "tools/vobench/large_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <opencv2/core/mat.hpp>

namespace vobench {
namespace {

constexpr std::size_t kPage = std::size_t{2} << 20;

void RequestLargePages(void* block, std::size_t size) {
  if (size < 2 * kPage) return;
  const auto at = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t begin = (at + kPage - 1) / kPage * kPage, end = (at + size) / kPage * kPage;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

// OpenCV's own allocator, which it continues to free by.
class LargePages : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, std::size_t* step, cv::AccessFlag access,
                         cv::UMatUsageFlags usage) const override {
    cv::UMatData* block = own_.allocate(dims, sizes, type, data, step, access, usage);
    if (data == nullptr) RequestLargePages(block->data, block->size);
    return block;
  }
  bool allocate(cv::UMatData* block, cv::AccessFlag access, cv::UMatUsageFlags usage) const override {
    return own_.allocate(block, access, usage);
  }
  void deallocate(cv::UMatData* block) const override { own_.deallocate(block); }

 private:
  const cv::MatAllocator& own_ = *cv::Mat::getStdAllocator();
};

}  // namespace

void UseLargePagesForMatrices() {
  static LargePages allocator;
  cv::Mat::setDefaultAllocator(&allocator);
}

}  // namespace vobench

#ifndef VOBENCH_SANITIZED  // the sanitizers have their own
namespace {

void* Checked(void* block, std::size_t size) {
  if (block == nullptr) throw std::bad_alloc();
  vobench::RequestLargePages(block, size);
  return block;
}

}  // namespace

void* operator new(std::size_t size) { return Checked(std::malloc(std::max<std::size_t>(size, 1)), size); }
void* operator new(std::size_t size, std::align_val_t align) {
  const auto unit = static_cast<std::size_t>(align);
  return Checked(std::aligned_alloc(unit, (std::max<std::size_t>(size, 1) + unit - 1) / unit * unit), size);
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }
#endif
