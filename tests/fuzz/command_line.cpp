// A command line, one word a line: parsed, and turned into what is asked of the lab, which is not asked.
#include "cli/arguments/arguments.h"
#include "cli/arguments/requests.h"
#include "fuzz/fuzz_input.h"

namespace {
using namespace hwsim;

void plan(const cli::RunArguments& options) {
  static lab::Lab lab;
  cli::plan_of(options, lab);
}
void plan(const cli::SweepArguments& options) {
  plan(static_cast<const cli::RunArguments&>(options));
  if (options.shard) lab::parse_shard(*options.shard);
}
void plan(const cli::ReferenceArguments& options) { cli::view_of(options.view); }
void plan(const cli::ShowArguments& options) { cli::parse_sets(options.sets); }
void plan(const cli::ConfigArguments& options) { cli::parse_sets(options.sets); }
template <class Other>
void plan(const Other&) {}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> words{"hwsim"};
  for (const fuzz::Bytes word : fuzz::pieces(fuzz::Bytes(data, size), '\n'))
    words.emplace_back(fuzz::text_of(word).substr(0, fuzz::text_of(word).find('\0')));
  std::vector<const char*> arguments;
  for (const std::string& word : words) arguments.push_back(word.c_str());
  fuzz::answer_or_refuse([&] {
    const cli::Command command = cli::parse_arguments(static_cast<int>(arguments.size()), arguments.data());
    std::visit([](const auto& options) { plan(options); }, command);
  });
  return 0;
}
