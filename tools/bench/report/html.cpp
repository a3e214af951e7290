#include "tools/bench/report/html.h"

#include <nlohmann/json.hpp>

#include "tools/bench/report/thin.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

constexpr std::size_t kNumbers = 150'000;  // 5.3 bytes each
constexpr std::size_t kColours = 5;

// Content policy: no external resources.
constexpr const char* kPolicy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; "
    "form-action 'none'";

std::vector<Figure> FiguresOf(const Page& page) {
  std::vector<Figure> figures;
  for (const Section& section : page.sections) {
    figures.insert(figures.end(), section.figures.begin(), section.figures.end());
  }
  return figures;
}

// Panels in three columns where there is room; two are wider.
std::string Grid(const Section& section, std::size_t& number) {
  if (section.figures.empty()) return "";
  const char* style = section.figures.size() <= 2 || section.figures.size() == 4 ? "grid two" : "grid";
  std::string html = std::string("<div class=\"") + style + "\">";
  for (const Figure& figure : section.figures) {
    html += "<figure class=\"figure\" id=\"f" + std::to_string(number++) + "\"><figcaption>" + Escape(figure.title) +
            "</figcaption></figure>\n";
  }
  html += "</div>\n";
  if (section.fold.empty()) return html;
  return "<details class=\"figures\"><summary>" + Escape(section.fold) + "</summary>" + html + "</details>\n";
}

std::string Of(const Section& section, std::size_t& number) {
  if (section.figures.empty() && section.body.empty()) return "";
  const bool drawn_only = section.body.empty();
  return std::string("<section") + (drawn_only ? " class=\"drawn\"" : "") + "><h2>" + Escape(section.title) +
         "</h2>\n" + (section.words.empty() ? "" : "<p>" + section.words + "</p>\n") + Grid(section, number) +
         section.body + "</section>\n";
}

std::string FramesSection(const FrameViewer& viewer) {
  if (viewer.frames.empty()) return "";
  return "<section class=\"drawn\"><h2>Frames</h2>\n<p>What was looked for is drawn over the picture: where each "
         "landmark was expected, with the ellipse in which 95 of 100 matches should lie, and where it was "
         "found.</p>\n<div id=\"frames\"></div></section>\n";
}

// Data for the page's script.
std::string DataJson(const Page& page) {
  nlohmann::ordered_json more = nlohmann::ordered_json::object();
  if (page.frames) more["frames"] = ToJson(*page.frames);
  return FiguresJson(page.systems, ThinTo(FiguresOf(page), kNumbers), more);
}

}  // namespace

std::string Html(const Page& page) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
      std::string(kPolicy) + "\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
      Escape(page.title) + " – vobench</title><style>" + Style() + "</style></head><body><main>\n<h1>" +
      Escape(page.title) + "</h1>\n<div id=\"summary\">" + page.summary +
      "</div>\n<p class=\"hint unscripted\">Diagrams need scripts, which this browser does not run here. Words and "
      "tables are complete.</p>\n";
  std::size_t number = 0;
  for (std::size_t i = 0; i < page.sections.size(); ++i) {
    if (page.frames && i + 1 == page.sections.size()) html += FramesSection(*page.frames);
    html += Of(page.sections[i], number);
  }
  return html + "</main><script type=\"application/json\" id=\"data\">" + DataJson(page) + "</script>\n<script>" +
         Script() + "</script></body></html>\n";
}

std::string Table(const std::string& caption, const std::vector<std::vector<std::string>>& rows) {
  if (rows.empty()) return "";
  std::string html = "<div class=\"table\"><div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Table: " +
                     Escape(caption) + "\"><table><caption>" + Escape(caption) + "</caption><thead><tr>";
  for (const std::string& cell : rows.front()) html += "<th scope=\"col\">" + cell + "</th>";
  html += "</tr></thead><tbody>\n";
  for (std::size_t i = 1; i < rows.size(); ++i) {
    html += "<tr><th scope=\"row\">" + rows[i].front() + "</th>";
    for (std::size_t k = 1; k < rows[i].size(); ++k) html += "<td>" + rows[i][k] + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div></div>\n";
}

std::string Tiles(const std::vector<Tile>& tiles) {
  std::string html = "<div class=\"tiles\">";
  for (const Tile& tile : tiles) {
    html += "<div class=\"tile\"><div class=\"value\">" + tile.value + "</div><div>" + tile.what +
            "</div><div class=\"note\">" + tile.note + "</div></div>";
  }
  return html + "</div>\n";
}

std::string Key(std::size_t system) { return "<span class=\"key s" + std::to_string(system % kColours) + "\"></span>"; }

}  // namespace vobench::report
