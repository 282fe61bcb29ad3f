#include "program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "goshawk/runtime/node.hpp"
#include "goshawk/runtime/parameters.hpp"

namespace goshawk::cli {
namespace {

constexpr const char* kRosArgs = "--ros-args";

bool is_option(const std::string& word) {
  return word.size() > 1 && word.front() == '-';
}

/// The verb that was called, as far as it was understood, root first.
std::vector<const CLI::App*> called(const CLI::App& root) {
  std::vector<const CLI::App*> chain{&root};
  while (!chain.back()->get_subcommands().empty()) {
    chain.push_back(chain.back()->get_subcommands().back());
  }
  return chain;
}

Words words_below(const CLI::App& app) {
  Words names;
  for (const auto* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_group().empty()) names.push_back(sub->get_name());
  }
  return names;
}

const CLI::App* find_below(const CLI::App& app, const std::string& name) {
  const auto found = app.get_subcommands([&](const CLI::App* a) { return a->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

Words options_of(const CLI::App& app) {
  Words names;
  for (const auto* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden from help as well
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    for (const auto& name : option->get_snames()) {
      if (option->get_lnames().empty()) names.push_back("-" + name);
    }
  }
  return names;
}

std::string path_of(const CLI::App& app) {
  if (app.get_parent() == nullptr) return "";
  const std::string above = path_of(*app.get_parent());
  return above + (above.empty() ? "" : " ") + app.get_name();
}

std::string call_of(const CLI::App& app) {
  return "goshawk" + (app.get_parent() == nullptr ? "" : " " + path_of(app));
}

std::string did_you_mean(const std::string& word, const Words& known) {
  const std::string near = runtime::nearest_name(word, known);
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

/// A word that no option and no verb took.
std::string about_stray(const std::string& word, const CLI::App& app) {
  const std::string more = fmt::format(" ({} --help lists them)", call_of(app));
  if (is_option(word)) {
    const std::string name = word.substr(0, word.find('='));
    return fmt::format("there is no option {}{}{}", name, did_you_mean(name, options_of(app)),
                       more);
  }
  const Words verbs = words_below(app);
  if (verbs.empty()) return fmt::format("'{}' is one word too many", word);
  return fmt::format("there is no verb '{}'{}{}", word, did_you_mean(word, verbs), more);
}

/// "--wind: Value 99 not in range 0.000000 to 15.000000" with sensible digits.
std::optional<std::string> about_range(const std::string& text) {
  constexpr std::string_view kValue = ": Value ", kRange = " not in range ", kTo = " to ";
  const auto value = text.find(kValue), range = text.find(kRange), to = text.find(kTo, range);
  if (to == std::string::npos || value == std::string::npos) return {};
  const std::string name = text.substr(0, value);
  const auto value_at = value + kValue.size();
  const std::string given = text.substr(value_at, range - value_at);
  char* end = nullptr;
  std::strtod(given.c_str(), &end);
  if (given.empty() || *end != '\0') return fmt::format("{}: '{}' is not a number", name, given);
  const char* least = text.c_str() + range + kRange.size();
  return fmt::format("{}: {} is not from {:.10g} to {:.10g}", name, given,
                     std::strtod(least, nullptr),
                     std::strtod(text.c_str() + to + kTo.size(), nullptr));
}

/// CLI11's sentence, in our words if its own are hard to read.
std::string about(const CLI::ParseError& error, const CLI::App& app) {
  const std::string text = error.what();
  const std::string conversion = "Could not convert: ";
  if (text.starts_with(conversion)) {
    const auto equals = text.find(" = ");
    return fmt::format("{}: '{}' is not a number",
                       text.substr(conversion.size(), equals - conversion.size()),
                       text.substr(equals + 3));
  }
  if (const auto range = about_range(text)) return *range;
  if (error.get_name() == "RequiredError" && !words_below(app).empty()) {
    return fmt::format("a verb is missing: {} {}", call_of(app),
                       fmt::join(words_below(app), " | "));
  }
  const std::string excludes = " excludes ";
  if (const auto at = text.find(excludes); error.get_name() == "ExcludesError") {
    return fmt::format("{} and {}: give one of them, not both", text.substr(0, at),
                       text.substr(at + excludes.size()));
  }
  return text;
}

bool is_value_fault(const CLI::ParseError& error) {
  return error.get_name() == "ValidationError" || error.get_name() == "ConversionError";
}

int report_bug(const Console& console, const std::exception& bug) {
  console.say(fmt::format("internal fault: {}", bug.what()));
  return kNotDone;
}

}  // namespace

std::string Verb::path() const {
  return path_of(*app_);
}

Verb Verb::word(const std::string& name, const std::string& summary) const {
  CLI::App* below = app_->add_subcommand(name, summary)->group("Verbs");
  app_->require_subcommand(1);
  return {*program_, *below};
}

void Verb::runs(std::function<int(const Console&)> run) const {
  app_->add_flag("--json", program_->json_, "results and failures as JSON (docs/cli.md)");
  program_->runs_[app_] = std::move(run);
}

void Verb::takes_ros_args(Words& rest) const {
  program_->ros_args_[app_] = &rest;
}

CLI::Option* Verb::choice(const std::string& name, std::string& value, const std::string& what,
                          Words choices) const {
  CLI::Option* option = app_->add_option(name, value, what);
  option->check([choices](const std::string& text) -> std::string {
    if (std::ranges::find(choices, text) != choices.end()) return "";
    return fmt::format("'{}' is not one of {}{}", text, fmt::join(choices, ", "),
                       did_you_mean(text, choices));
  });
  completes(option, [choices](const Words&) { return choices; });
  return option;
}

void Verb::completes(const CLI::Option* option, Completer completer) const {
  program_->completers_[option] = std::move(completer);
}

/// Where a line of words leads: the verb, its positional words so far, and an option that still
/// waits for its value.
struct Program::Place {
  const CLI::App* app;
  Words positional = {};
  const CLI::Option* pending = nullptr;
};

Program::Program() : app_("Plan and fly through clutter.", "goshawk") {
  app_.get_formatter()->label("SUBCOMMAND", "VERB ...");
  app_.require_subcommand(1);
}

Verb Program::verb(const std::string& name, const std::string& summary) {
  return {*this, *app_.add_subcommand(name, summary)->group("Verbs")};
}

int Program::run(Words arguments) {
  if (arguments.empty()) {
    fmt::print(stderr, "{}", app_.help());
    return kWrongCall;
  }
  // What stands behind --ros-args has a syntax of its own.
  const auto cut = std::ranges::find(arguments, kRosArgs);
  const auto rest = ros_args_.find(place_of({arguments.begin(), cut}).app);
  if (cut != arguments.end() && rest != ros_args_.end()) {
    rest->second->assign(cut + 1, arguments.end());
    arguments.erase(cut, arguments.end());
  }
  const bool json = std::ranges::find(arguments, "--json") != arguments.end();
  return parse_and_run(std::move(arguments), json);
}

int Program::parse_and_run(Words arguments, bool json) {
  std::ranges::reverse(arguments);  // CLI11 takes them from the back
  try {
    app_.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return refuse(error, json);
    app_.exit(error);  // help, version
    return kDone;
  }
  const CLI::App* app = called(app_).back();
  const Console console(path_of(*app), json_);
  try {
    return runs_.at(app)(console);
  } catch (const runtime::StartupFault& fault) {
    return console.failed(fault.error());
  } catch (const std::exception& bug) {
    return report_bug(console, bug);
  }
}

int Program::refuse(const CLI::ParseError& error, bool json) const {
  const auto chain = called(app_);
  const Console console(path_of(*chain.back()), json);
  // A word that nothing took explains more than what is missing because of it.
  for (const CLI::App* app : chain) {
    const Words stray = app->remaining();
    if (stray.empty()) continue;
    return console.wrong_call({ErrorCode::invalid_input, about_stray(stray.front(), *app)});
  }
  const ErrorCode code =
      is_value_fault(error) ? ErrorCode::invalid_parameter : ErrorCode::invalid_input;
  return console.wrong_call({code, about(error, *chain.back())});
}

int Program::help(const Words& words) {
  const Place place = place_of(words);
  if (!place.positional.empty()) {
    const Console console("help", json_);
    return console.wrong_call(
        {ErrorCode::invalid_input, about_stray(place.positional.front(), *place.app)});
  }
  Words arguments = words;
  arguments.emplace_back("--help");
  app_.clear();
  return parse_and_run(std::move(arguments), json_);
}

Program::Place Program::place_of(const Words& words) const {
  Place place{&app_};
  bool many = false;
  for (const std::string& word : words) {
    if (place.pending != nullptr && !is_option(word)) {
      if (!many) place.pending = nullptr;
    } else if (is_option(word)) {
      const auto* option =
          word.find('=') == std::string::npos ? place.app->get_option_no_throw(word) : nullptr;
      const int most = option == nullptr ? 0 : option->get_items_expected_max();
      place.pending = most > 0 ? option : nullptr;
      many = most > 1;
    } else if (const auto* sub = find_below(*place.app, word)) {
      place = {sub};
    } else {
      place.positional.push_back(word);
    }
  }
  return place;
}

Words Program::values_of(const CLI::Option* option, const Words& before) const {
  const auto found = completers_.find(option);
  return found == completers_.end() ? Words() : found->second(before);
}

Words Program::complete(Words words) const {
  if (words.empty()) return words_below(app_);
  // bash takes --option=value apart.
  const std::string last = words.back() == "=" ? "" : words.back();
  std::erase(words, "=");
  if (last.empty() && (words.empty() || !words.back().empty())) words.emplace_back();
  const Place place = place_of({words.begin(), words.end() - 1});
  if (is_option(words.back()) || words.back() == "-") return options_of(*place.app);
  if (place.pending != nullptr) return values_of(place.pending, place.positional);
  if (const Words verbs = words_below(*place.app); !verbs.empty()) return verbs;
  // The positional whose turn it is; the last one may take many.
  const CLI::Option* next = nullptr;
  std::size_t taken = 0;
  for (const auto* option : place.app->get_options()) {
    if (!option->get_positional()) continue;
    next = option;
    if (taken + std::size_t(option->get_items_expected_max()) > place.positional.size()) break;
    taken += std::size_t(option->get_items_expected_max());
  }
  return next == nullptr ? Words() : values_of(next, place.positional);
}

}  // namespace goshawk::cli
