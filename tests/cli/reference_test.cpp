// docs/reference/ holds what the program prints today. With HWSIM_WRITE_REFERENCE set, this test writes the
// pages (scripts/reference.sh); otherwise it compares them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/program.h"
#include "support/places.h"

namespace hwsim::cli::test {
namespace {

using json = nlohmann::ordered_json;

std::string escaped(const std::string& text) {
  std::string cell;
  for (const char c : text) {
    if (c == '|') cell += '\\';
    cell += c == '\n' ? ' ' : c;
  }
  return cell;
}

std::string row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + escaped(cell) + " |";
  return line + "\n";
}

std::string table_head(const std::vector<std::string>& names) {
  return row(names) + row(std::vector<std::string>(names.size(), "---"));
}

json printed(const Workplace& place, const std::string& arguments) {
  const Outcome outcome = place.hwsim(arguments);
  EXPECT_EQ(outcome.status, 0) << arguments << ": " << outcome.err;
  return json::parse(outcome.out);
}

std::string counters_page(const Workplace& place) {
  std::string page =
      "# Counters\n\nThis page lists every count of work that a run prints, and what one count is. `hwsim "
      "list counters` prints "
      "the same.\nEach counter is an integer; its last word says what is counted.\n";
  std::string unit;
  for (const json& counter : printed(place, "list counters --json")) {
    if (counter["unit"] != unit) {
      unit = counter["unit"];
      page += "\n## " + unit + "\n\n" + table_head({"id", "one count is"});
    }
    page += row({"`" + counter["id"].get<std::string>() + "`", counter["description"]});
  }
  return page;
}

std::string techniques_page(const Workplace& place) {
  std::string page =
      "# Parameters of techniques\n\nThis page lists the techniques with their parameters, as `hwsim show "
      "NAME` prints them. What "
      "the techniques do is\ndescribed in [techniques](../techniques/README.md).\n";
  for (const json& technique : printed(place, "list techniques --json")) {
    const std::string name = technique["name"];
    page += "\n## " + name + "\n\n" + technique["kind"].get<std::string>() + ": " +
            technique["description"].get<std::string>() + "\n";
    const json parameters = printed(place, "show " + name + " --json");
    if (parameters.empty()) continue;
    page += "\n" + table_head({"parameter", "default", "range", "meaning"});
    for (const json& p : parameters)
      page +=
          row({"`" + p["parameter"].get<std::string>() + "`", p["default"], p["range"], p["description"]});
  }
  return page;
}

std::string range_of(const json& value) {
  const json& plain = value["anyOf"][0];
  if (plain.contains("minimum")) {
    std::ostringstream range;
    range << plain["minimum"].get<double>() << " to " << plain["maximum"].get<double>();
    return range.str();
  }
  return plain["type"];
}

std::string key_rows(const json& properties) {
  std::string rows = table_head({"key", "range", "default", "meaning"});
  for (const auto& [key, value] : properties.items())
    if (value.contains("anyOf"))
      rows += row({"`" + key + "`", range_of(value), value.contains("default") ? value["default"].dump() : "",
                   value["description"]});
  return rows;
}

std::string gpu_keys_page(const Workplace& place) {
  const json properties = printed(place, "config schema gpu")["properties"];
  return "# Keys of GPU files\n\nThis page lists what a GPU file may say. `hwsim config schema gpu` prints "
         "it as a JSON Schema, "
         "`hwsim show gtx980 --origin` the\nvalues of one GPU with their sources. How each value is used is "
         "described in [the "
         "hardware model](../hardware_model.md).\nA value without a default must be given, by the file or "
         "one that it extends.\n\n## "
         "Values\n\n" +
         key_rows(properties) +
         "\n## Features\n\nWritten below `[features]`. They decide what a technique may ask for.\n\n" +
         key_rows(properties["features"]["properties"]);
}

std::string errors_page(const Workplace& place) {
  std::string page =
      "# Codes of messages\n\nThis page lists the codes of errors, warnings and notes. `hwsim help CODE` "
      "explains one. What a "
      "message looks like is\ndescribed in [architecture](../architecture.md#errors).\n\n" +
      table_head({"code", "means", "explanation"});
  for (const json& code : printed(place, "help --json")) {
    const std::string name = code["code"], help = place.hwsim("help " + name).out;
    const std::size_t begin = std::min(help.find("\n\n"), help.size());
    std::string text = help.substr(std::min(begin + 2, help.size()));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    page += row({name, code["title"], text});
  }
  return page;
}

std::string sources_page(const Workplace& place) {
  std::string page =
      "# Sources\n\nThis page lists the documents that values of GPU files name by a key, as `hwsim list "
      "sources` prints "
      "them.\n[Hardware sources](../hardware_sources.md) says what is known of each GPU from them, and where "
      "they "
      "contradict each other.\n\n" +
      table_head({"key", "document", "what was taken"});
  for (const json& source : printed(place, "list sources --json"))
    page += row({"[" + source["key"].get<std::string>() + "]", source["document"], source["taken"]});
  return page;
}

std::string reference_path(const std::string& name) {
  return hwsim::test::source_dir() + "/docs/reference/" + name + ".md";
}

void compare(const std::string& name, const std::function<std::string(const Workplace&)>& page) {
  const Workplace place;
  const std::string text = page(place);
  if (std::getenv("HWSIM_WRITE_REFERENCE") != nullptr) {
    std::ofstream(reference_path(name)) << text;
    return;
  }
  std::ostringstream kept;
  kept << std::ifstream(reference_path(name)).rdbuf();
  EXPECT_TRUE(kept.str() == text)
      << "docs/reference/" << name
      << ".md is not what the program prints; scripts/reference.sh writes it anew";
}

TEST(Reference, CountersAreThoseOfTheProgram) { compare("counters", counters_page); }
TEST(Reference, ParametersAreThoseOfTheProgram) { compare("techniques", techniques_page); }
TEST(Reference, GpuKeysAreThoseOfTheProgram) { compare("gpu_keys", gpu_keys_page); }
TEST(Reference, SourcesAreThoseOfTheProgram) { compare("sources", sources_page); }
TEST(Reference, CodesAreThoseOfTheProgram) { compare("errors", errors_page); }

}  // namespace
}  // namespace hwsim::cli::test
