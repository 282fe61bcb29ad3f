#include "common/report.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

namespace goshawk::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value.get<double>());
  return text;
}

Json plot_json(const Plot& p) {
  return {{"file", p.file},
          {"title", p.title},
          {"x", p.x},
          {"y", p.y},
          {"x_label", p.x_label},
          {"y_label", p.y_label},
          {"series", p.series},
          {"where", p.where},
          {"log_x", p.log_x},
          {"log_y", p.log_y},
          {"points_only", p.points_only},
          {"from", p.from}};
}

/// Rows of one table, keys of the first row as columns.
std::string table_text(const std::vector<const Json*>& rows) {
  std::vector<std::vector<std::string>> lines(1);
  for (const auto& [key, value] : rows.front()->items()) lines[0].push_back(key);
  for (const Json* row : rows) {
    auto& line = lines.emplace_back();
    for (const std::string& key : lines[0]) line.push_back(cell(row->value(key, Json())));
  }
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) {
      std::size_t width = 0;
      for (const auto& other : lines) width = std::max(width, other[c].size());
      text += line[c] + std::string(width - line[c].size() + 2, ' ');
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

/// A note that holds rows is a table of its own; a long one is for the pictures.
std::string note_text(const std::string& key, const Json& value) {
  constexpr std::size_t kLongest = 40;
  const bool rows = value.is_array() && !value.empty() && value.front().is_object();
  if (!rows) return "\n" + key + ": " + cell(value) + "\n";
  if (value.size() > kLongest) return "";
  std::vector<const Json*> lines;
  for (const Json& row : value) lines.push_back(&row);
  return "\n" + key + "\n" + table_text(lines);
}

/// The drawing script lies beside the bench programs.
std::filesystem::path script() {
  return std::filesystem::canonical("/proc/self/exe").parent_path() / "draw_plots.py";
}

int write_pictures(const Json& report, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const auto file = std::filesystem::path(folder) / "report.json";
  std::ofstream out(file);
  out << report.dump(1) << '\n';
  if (!out.flush()) {
    std::fprintf(stderr, "cannot write %s: is the folder writable?\n", file.c_str());
    return 1;
  }
  const std::string command =
      "/usr/bin/python3 '" + script().string() + "' '" + file.string() + "'";
  return std::system(command.c_str()) == 0 ? 0 : 1;
}

}  // namespace

void Report::progress(const std::string& what) const {
  std::fprintf(stderr, "%s: %s\n", name_.c_str(), what.c_str());
}

Json Report::to_json() const {
  Json json{{"bench", name_}, {"quick", options_.quick}};
  json["cores"] = std::thread::hardware_concurrency();
  for (const auto& [key, value] : notes_.items()) json[key] = value;
  json["rows"] = rows_;
  json["plots"] = Json::array();
  for (const Plot& p : plots_) json["plots"].push_back(plot_json(p));
  return json;
}

std::string Report::to_text() const {
  std::vector<std::string> order;
  std::map<std::string, std::vector<const Json*>> tables;
  for (const Json& row : rows_) {
    const std::string table = row.contains("table") ? cell(row["table"]) : name_;
    if (!tables.contains(table)) order.push_back(table);
    tables[table].push_back(&row);
  }
  std::string text;
  for (const std::string& table : order) text += "\n" + table_text(tables[table]);
  for (const auto& [key, value] : notes_.items()) text += note_text(key, value);
  return text;
}

int Report::finish() const {
  const std::string text = options_.json ? to_json().dump(1) + "\n" : to_text();
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
  return options_.plots.empty() ? 0 : write_pictures(to_json(), options_.plots);
}

Options Options::of(const Call& call) {
  return {call.at("json").get<bool>(), call.at("quick").get<bool>(),
          call.at("plots").get<std::string>()};
}

int bench_main(int argc, char** argv, const std::string& name, void (*run)(Report&)) {
  return bench_call(argc, argv, name, [&](const Call& call) {
    Report report(name, Options::of(call));
    run(report);
    return report.finish();
  });
}

}  // namespace goshawk::bench
