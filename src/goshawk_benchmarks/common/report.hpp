#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/call.hpp"

namespace goshawk::bench {

/// What most bench programs understand.
struct Options {
  bool json = false;       // one JSON object on standard output, else a table
  bool quick = false;      // less of everything: ends within 40 s
  std::string plots = {};  // folder for the pictures, empty for none

  static Options of(const Call& call);
};

/// Lines or points of some rows: x and y are keys of the rows, one line for each value of
/// `series`. `where` keeps the rows whose keys have these values.
struct Plot {
  std::string file = {};  // name without folder and suffix
  std::string title = {};
  std::string x = {};
  std::string y = {};
  std::string x_label = {};  // with unit
  std::string y_label = {};  // with unit
  std::string series = {};   // key of the rows
  nlohmann::json where = nlohmann::json::object();
  bool log_x = false;
  bool log_y = false;
  bool points_only = false;
  std::string from = "rows";  // or the key of a note that holds rows of another kind

  /// Another column of the same rows over the same x.
  Plot of(std::string its_file, std::string its_title, std::string its_y,
          std::string its_y_label) const {
    Plot plot = *this;
    plot.file = std::move(its_file);
    plot.title = std::move(its_title);
    plot.y = std::move(its_y);
    plot.y_label = std::move(its_y_label);
    return plot;
  }
};

/// Rows of a benchmark, written as a table or as JSON, and as pictures.
class Report {
 public:
  Report(std::string name, Options options) : name_(std::move(name)), options_(options) {}

  const Options& options() const { return options_; }

  /// @param row a JSON object; rows of one `table` should have the same keys
  void add(nlohmann::ordered_json row) { rows_.push_back(std::move(row)); }
  void draw(Plot plot) { plots_.push_back(std::move(plot)); }
  /// A fact about the whole run, e.g. a fitted exponent; beside `rows` in the JSON.
  void note(const std::string& key, nlohmann::ordered_json value) { notes_[key] = value; }

  /// One line on standard error, so that long work shows where it is.
  void progress(const std::string& what) const;

  nlohmann::ordered_json to_json() const;
  /// One table for each value of the rows' `table`, columns as wide as their content.
  std::string to_text() const;

  /// Writes to standard output, then draws with matplotlib.
  /// @return exit status: 0, or 1 with a sentence on standard error if a picture failed
  int finish() const;

 private:
  std::string name_;
  Options options_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json notes_ = nlohmann::ordered_json::object();
  std::vector<Plot> plots_;
};

/// main() of a bench program that has no options of its own.
/// @param run fills the report
/// @return 0; 1 if `run` threw or a picture failed
int bench_main(int argc, char** argv, const std::string& name, void (*run)(Report&));

}  // namespace goshawk::bench
