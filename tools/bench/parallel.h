// Parallel loop over items on a given number of threads. Items share nothing: results do not depend on that number.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <vector>

namespace vobench {

// task(item) for every item. The first exception that a task throws is thrown here.
template <class Item, class Task>
void ForEach(std::vector<Item>& items, int jobs, const Task& task) {
  tbb::task_arena arena(jobs);
  arena.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, items.size(), [&](std::size_t i) { task(items[i]); }, tbb::simple_partitioner());
  });
}

}  // namespace vobench
