// Data of a page, parsed as by a browser.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vobench::report {

// Content of the element "data"; the test fails where the page has none.
nlohmann::json DataOf(const std::string& html);

// The figure of this title; null where there is none.
nlohmann::json FigureOf(const nlohmann::json& data, const std::string& title);

// A column's numbers.
std::vector<float> Column(const nlohmann::json& data, const nlohmann::json& index);

}  // namespace vobench::report
