// HTML page from words, tables, figures and pictures: one file that loads nothing.
// Source: docs/report_data.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/bench/report/figure.h"
#include "tools/bench/report/frame_viewer.h"

namespace vobench::report {

struct Section {
  std::string title;       // text; as are those of figures
  std::string words = {};  // HTML, one paragraph
  std::vector<Figure> figures = {};
  std::string body = {};  // HTML, below the figures
  std::string fold = {};  // figures stand behind this word, to be opened
};

struct Page {
  std::string title;
  std::string summary;                     // HTML, above all sections
  std::vector<std::string> systems;        // as written in legends
  std::vector<Section> sections;           // those without figures, frames and body are left out
  std::optional<FrameViewer> frames = {};  // before the last section
};

// Page and data stay below 3 MB: figures are thinned to 150 000 numbers. A browser without scripts shows words and
// tables, and says so.
std::string Html(const Page& page);

// A table that a script can sort and copy. Cells are HTML; the first row is the head, the first column names the rows.
std::string Table(const std::string& caption, const std::vector<std::vector<std::string>>& rows);

// The numbers that matter: a large value, what it is, and small print. HTML.
struct Tile {
  std::string value, what, note;
};
std::string Tiles(const std::vector<Tile>& tiles);

// The colour of a system in words: a small square.
std::string Key(std::size_t system);

// Style and script of the page, embedded by the build from tools/bench/report/web/.
const std::string& Style();
const std::string& Script();

}  // namespace vobench::report
