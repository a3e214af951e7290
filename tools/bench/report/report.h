// Purpose: report.html, one self-contained page from the files of a result folder.
// Source:  docs/result_folder.md for the files, docs/report.md for what the page shows.
#pragma once

#include <filesystem>

namespace report {

// Reads OUT/run.json, OUT/metrics.json (where there is one) and the run folders named there; writes OUT/report.html
// whole or not at all. Errors are computed anew from estimate and truth with the options recorded in metrics.json;
// should they differ from what is recorded there, the page says so. Throws std::invalid_argument naming every file and
// line that is wrong, std::runtime_error when the page cannot be written.
void WriteReport(const std::filesystem::path& out);

}  // namespace report
