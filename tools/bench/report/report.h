// Page of a run: report.html, one self-contained file from a result folder.
// Source: docs/result_folder.md for the files, docs/report.md for what the page shows.
#pragma once

#include <filesystem>

#include "tools/bench/result/result.h"

namespace vobench::report {

// Writes OUT/report.html atomically. Pictures are read from OUT. Throws evaluation::InputError where one cannot be
// read, std::runtime_error when the page cannot be written.
void WriteReport(const std::filesystem::path& out, const ResultData& data);

// Of ReadResult(out): errors are computed anew from estimate and truth with the options recorded in metrics.json; the
// page reports a difference from the recorded ones.
void WriteReport(const std::filesystem::path& out);

}  // namespace vobench::report
