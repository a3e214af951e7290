// HTML page of text, tables, figures and pictures: one self-contained file.
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
  std::string fold = {};  // title of a fold that contains the figures
};

struct Page {
  std::string title;
  std::string summary;                     // HTML, above all sections
  std::vector<std::string> systems;        // as written in legends
  std::vector<Section> sections;           // those without figures, frames and body are left out
  std::optional<FrameViewer> frames = {};  // before the last section
};

// Page and data stay below 3 MB: figures are thinned to 150 000 numbers. A browser without scripts shows text, tables
// and a note.
std::string Html(const Page& page);

// A table that a script can sort and copy. Cells are HTML; the first row is the head, the first column names the rows.
std::string Table(const std::string& caption, const std::vector<std::vector<std::string>>& rows);

// A headline number: a large value, its name, and small print. HTML.
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
