// CLI11 costs six seconds of compile time: it is named in this file, argument_groups and argument_errors
// only.
#include "cli/arguments/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <memory>
#include <sstream>

#include "cli/arguments/argument_errors.h"
#include "cli/arguments/argument_groups.h"
#include "cli/arguments/help_texts.h"
#include "lab/base/messages.h"

namespace hwsim::cli {
namespace {

/// The sentence of a help text that says what the command does; it follows the examples.
std::string summary_of(const std::string& help) {
  const auto gap = help.rfind("\n\n");
  const size_t start = gap == std::string::npos ? 0 : gap + 2;
  std::string sentence = help.substr(start, help.find('.', start) - start);
  std::replace(sentence.begin(), sentence.end(), '\n', ' ');
  return sentence;
}

/// Commands are listed with their sentence, not with their examples.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_subcommand(const CLI::App* sub) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, sub->get_name(), summary_of(sub->get_description()), get_column_width());
    return out.str();
  }
};

/// The application and what its flags write to.
struct Parser {
  CLI::App app{std::string(kHelpTop), "hwsim"};
  RunArguments run;
  CompareArguments compare;
  ExplainArguments explain;
  RankArguments rank;
  SweepArguments sweep;
  OptimizeArguments optimize;
  ReportArguments report;
  ReferenceArguments reference;
  ListArguments list;
  ShowArguments show;
  SceneCheckArguments scene_check;
  ConfigArguments config;
  DoctorArguments doctor;
  HelpArguments help;
  CacheArguments cache;
  FitArguments fit;
  ValidateArguments validate;
  ReproduceArguments reproduce;
  CompletionArguments completion;
  GpuNewArguments gpu_new;

  Parser();
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;
  Command command() const;

 private:
  std::map<const CLI::App*, std::function<Command()>> results_;

  CLI::App& add(CLI::App& parent, const std::string& name, std::string_view text,
                std::function<Command()> result);
  void add_run();
  void add_compare();
  void add_explain();
  void add_rank();
  void add_sweep();
  void add_optimize();
  void add_report();
  void add_reference();
  void add_list_and_show();
  void add_scene();
  void add_gpu();
  void add_config();
  void add_cache();
  void add_calibration();
  void add_rest();
};

CLI::App& Parser::add(CLI::App& parent, const std::string& name, std::string_view text,
                      std::function<Command()> result) {
  CLI::App& sub = *parent.add_subcommand(name, std::string(text));
  sub.set_help_flag("-h,--help", "This text");
  results_[&sub] = std::move(result);
  return sub;
}

void Parser::add_run() {
  CLI::App& sub = add(app, "run", kHelpRun, [this] { return Command(run); });
  add_view(sub, run.view, true);
  add_points(sub, run);
  add_reference_samples(sub, run);
  add_no_image(sub, run);
  add_out(sub, run.out);
  add_report_file(sub, run.report);
  add_common(sub, run.common);
}

void Parser::add_compare() {
  CLI::App& sub = add(app, "compare", kHelpCompare, [this] { return Command(compare); });
  sub.add_option("SCENE|RESULTS", compare.inputs, "A scene, or folders of results")
      ->required()
      ->type_name(" ");
  add_view_flags(sub, compare.view);
  add_points(sub, compare);
  add_repeatable(sub, "--what-if", compare.what_ifs,
                 "Overlays of `hwsim list overlays`, each a result of its own; a+b lays both", "NAME,NAME");
  add_vary(sub, compare.vary, compare.zip);
  sub.add_flag("--counters", compare.counters, "Also the counters that changed");
  sub.add_flag("--all", compare.all, "Also the passes that do not change");
  add_report_file(sub, compare.report);
  add_common(sub, compare.common);
}

void Parser::add_explain() {
  CLI::App& sub = add(app, "explain", kHelpExplain, [this] { return Command(explain); });
  add_view(sub, explain.view, true);
  add_points(sub, explain);
  sub.add_flag("--all", explain.all, "Also the parameters without influence");
  add_common(sub, explain.common);
}

void Parser::add_rank() {
  CLI::App& sub = add(app, "rank", kHelpRank, [this] { return Command(rank); });
  add_view(sub, rank.view, true);
  add_points(sub, rank, "all");
  add_reference_samples(sub, rank);
  add_no_image(sub, rank);
  sub.add_option("--budget", rank.budget, "Limits of aa_ms, frame_ms, extra_mib, memory_mib, dram_mb")
      ->type_name("LIMITS");
  sub.add_option("--metric", rank.metric, "The error of the image that orders techniques; default flip")
      ->type_name("flip|psnr|ssim");
  sub.add_flag("--edges", rank.edges, "Errors where the reference has edges alone, for flip and psnr");
  add_vary(sub, rank.vary, rank.zip);
  add_out(sub, rank.out);
  add_report_file(sub, rank.report);
  add_common(sub, rank.common);
}

void Parser::add_sweep() {
  CLI::App& sub = add(app, "sweep", kHelpSweep, [this] { return Command(sweep); });
  add_view(sub, sweep.view, false);
  add_points(sub, sweep);
  add_reference_samples(sub, sweep);
  add_vary(sub, sweep.vary, sweep.zip);
  sub.add_option("--sample", sweep.sample, "A sample of the ranges instead of every combination")
      ->type_name("lhs:POINTS");
  sub.add_option("--seed", sweep.seed, "Of the sample; default 1")->type_name("N");
  sub.add_option("--db", sweep.database, "The database; default sweep.sqlite")->type_name("FILE");
  sub.add_flag("--resume", sweep.resume, "Go on with a sweep: points that are done are kept");
  sub.add_flag("--force", sweep.out.force, "Replace the sweep in --db, the file of --plan");
  sub.add_option("--shard", sweep.shard, "Only the I-th of N parts of the points")->type_name("I/N");
  sub.add_flag("--alone", sweep.alone,
               "No other process works on --db: points that one was killed at, anywhere, are free");
  sub.add_option("--plan", sweep.plan,
                 "Write points and frames with their expected times (JSON); run nothing")
      ->type_name("FILE");
  sub.add_flag("--emulate-only", sweep.emulate_only,
               "Only the frames that points need, into the cache; --shard takes its share of the work");
  add_repeatable(sub, "--merge", sweep.merge,
                 "Take over the points of other databases; 'part*.sqlite' names several (repeatable)",
                 "FILE");
  sub.add_flag("--rows", sweep.rows,
               "Every point, not what they show together (CSV and JSON are always rows)");
  sub.add_flag("--dry-run", sweep.dry_run, "List the points, run nothing");
  add_report_file(sub, sweep.report);
  add_common(sub, sweep.common);
}

void Parser::add_optimize() {
  CLI::App& sub = add(app, "optimize", kHelpOptimize, [this] { return Command(optimize); });
  add_view(sub, optimize.view, true);
  add_points(sub, optimize);
  add_vary(sub, optimize.vary, optimize.zip);
  add_optimize_goal(sub, optimize);
  add_common(sub, optimize.common);
}

void Parser::add_report() {
  CLI::App& sub = add(app, "report", kHelpReport, [this] { return Command(report); });
  sub.add_option("RESULTS", report.inputs,
                 "Folders of `run` and `rank`, databases of `sweep`, JSON of `compare` and `rank`")
      ->required()
      ->type_name(" ");
  sub.add_option("-o,--out", report.file, "The page; default report.html")->type_name("FILE");
  sub.add_flag("--force", report.force, "Replace the file in --out");
  add_common(sub, report.common);
}

void Parser::add_reference() {
  CLI::App& sub = add(app, "reference", kHelpReference, [this] { return Command(reference); });
  add_view(sub, reference.view, true);
  sub.add_option("--samples", reference.samples, "Samples a pixel; default 64")
      ->check(whole_in(1, 65536))
      ->type_name("N");
  add_reference_shadows(sub, reference.view);
  add_out(sub, reference.out);
  add_common(sub, reference.common);
}

void Parser::add_list_and_show() {
  CLI::App& lister = add(app, "list", kHelpList, [this] { return Command(list); });
  lister
      .add_option("WHAT", list.what,
                  "gpus, scenes, techniques, counters, overlays, tables, papers, sources, settings or codes")
      ->required()
      ->type_name(" ");
  add_common(lister, list.common);
  CLI::App& shower = add(app, "show", kHelpShow, [this] { return Command(show); });
  shower
      .add_option("NAME", show.words,
                  "A GPU, scene, technique, counter or table; its kind may stand before it")
      ->required()
      ->expected(1, 2)
      ->type_name(" ");
  shower.add_flag("--origin", show.origin, "Where each value comes from");
  add_overlays(shower, show.overlays);
  add_sets(shower, show.sets);
  add_common(shower, show.common);
}

void Parser::add_scene() {
  CLI::App& parent = add(app, "scene", kHelpScene, nullptr);
  parent.require_subcommand(1);
  CLI::App& check = add(parent, "check", kHelpSceneCheck, [this] { return Command(scene_check); });
  check.add_option("SCENE", scene_check.scenes, "Files or generators")->required()->type_name(" ");
  add_common(check, scene_check.common);
}

void Parser::add_gpu() {
  CLI::App& parent = add(app, "gpu", kHelpGpu, nullptr);
  parent.require_subcommand(1);
  CLI::App& sub = add(parent, "new", kHelpGpuNew, [this] { return Command(gpu_new); });
  sub.add_option("NAME", gpu_new.sheet.id, "What the GPU is called")->required()->type_name(" ");
  sub.add_option("--like", gpu_new.like, "A GPU of the same kind, which the file extends")
      ->required()
      ->type_name("GPU");
  sub.add_option("--title", gpu_new.sheet.title, "Its name for people; default NAME")->type_name("TEXT");
  const auto number = [&](const std::string& flags, std::optional<double>& target, const std::string& text,
                          const std::string& unit) {
    add_number(sub, flags, target, text, number_in({}, unit == "N" ? "" : unit))->type_name(unit);
  };
  number("--sms,--cus,--cores", gpu_new.sheet.cores, "SMs, compute units: what `shader_cores` counts", "N");
  number("--rops", gpu_new.sheet.rops, "Pixels that the ROPs write in a clock", "N");
  number("--tmus", gpu_new.sheet.tmus, "Bilinear probes in a clock", "N");
  number("--gpcs,--rasterizers", gpu_new.sheet.rasterizers, "GPCs, shader engines: rasterizers", "N");
  number("--clock", gpu_new.sheet.clock_mhz, "Clock of the core", "MHz");
  number("--bandwidth", gpu_new.sheet.bandwidth_gb_s, "Of the DRAM, 1e9 bytes a second", "GB/s");
  sub.add_option("--l2", gpu_new.l2, "Size of L2: 512K, 36M")->type_name("SIZE");
  sub.add_option("--infinity-cache,--llc", gpu_new.llc, "Size of the cache between L2 and DRAM")
      ->type_name("SIZE");
  sub.add_option("-o,--out", gpu_new.out, "The file; default NAME.toml")->type_name("FILE");
  sub.add_flag("--force", gpu_new.force, "Replace the file");
  add_common(sub, gpu_new.common);
}

void Parser::add_config() {
  using Action = ConfigArguments::Action;
  CLI::App& parent = add(app, "config", kHelpConfig, nullptr);
  parent.require_subcommand(1);
  const auto action = [&](const std::string& name, std::string_view text, Action value) -> CLI::App& {
    CLI::App& sub = add(parent, name, text, [this, value] {
      ConfigArguments options = config;
      options.action = value;
      return Command(options);
    });
    add_common(sub, config.common);
    return sub;
  };
  CLI::App& check = action("check", kHelpConfigCheck, Action::check);
  check.add_option("FILE", config.names, "TOML files, or GPUs of `hwsim list gpus`")
      ->required()
      ->type_name(" ");
  CLI::App& shower = action("show", kHelpConfigShow, Action::show);
  shower.add_option("GPU", config.names, "A GPU or a .toml file")->required()->expected(1)->type_name(" ");
  shower.add_flag("--all,--origin", config.origin, "Where each value comes from");
  add_overlays(shower, config.overlays);
  add_sets(shower, config.sets);
  CLI::App& schema = action("schema", kHelpConfigSchema, Action::schema);
  schema.add_option("KIND", config.names, "gpu (default), run or manifest")->expected(0, 1)->type_name(" ");
  CLI::App& diff = action("diff", kHelpConfigDiff, Action::diff);
  diff.add_option("GPU", config.names, "Two GPUs or .toml files")->required()->expected(2)->type_name(" ");
}

void Parser::add_cache() {
  CLI::App& parent = add(app, "cache", kHelpCache, nullptr);
  parent.require_subcommand(1);
  CLI::App& lister = add(parent, "list", kHelpCacheList, [this] { return Command(cache); });
  add_common(lister, cache.common);
  CLI::App& prune = add(parent, "prune", kHelpCachePrune, [this] {
    CacheArguments options = cache;
    options.prune = true;
    return Command(options);
  });
  prune.add_flag("--all", cache.all, "Everything, however recent");
  prune.add_option("--older-than", cache.older_than_days, "Days since a file was written; default 30")
      ->check(whole_in(0, 36500))
      ->type_name("DAYS");
  prune
      .add_option("--keep-mib", cache.keep_mib, "Remove what was used least recently, until so much is left")
      ->type_name("MIB");
  prune.add_flag("--dry-run", cache.dry_run, "Say what would go, and keep it");
  add_common(prune, cache.common);
}

void Parser::add_calibration() {
  const auto add_papers = [](CLI::App& sub, FitArguments& options) {
    add_repeatable(sub, "--paper", options.papers, "Only the tables of this paper (repeatable)", "PAPER");
    sub.add_flag("--dry-run", options.dry_run, "List the rows and the runs that stand for them");
    add_common(sub, options.common);
  };
  CLI::App& fitter = add(app, "fit", kHelpFit, [this] { return Command(fit); });
  fitter.add_option("--starts", fit.starts, "Starts: the declared one, the others random; default 10")
      ->check(whole_in(1, 1000))
      ->type_name("N");
  add_out(fitter, fit.out);
  add_papers(fitter, fit);
  CLI::App& validator = add(app, "validate", kHelpValidate, [this] { return Command(validate); });
  add_papers(validator, validate);
  CLI::Option* external = validator.add_flag("--external", validate.external,
                                             "Other renderers' times (configs/external), which no fit sees");
  validator
      .add_option("--scenes", validate.scenes,
                  "Folder of scene files: emulates their frames anew, from kept work without it")
      ->needs(external)
      ->type_name("DIR");
  CLI::App& reproducer = add(app, "reproduce", kHelpReproduce, [this] { return Command(reproduce); });
  reproducer.add_option("PAPER", reproduce.paper, "As the published tables call it: sss, sbaa, ...")
      ->required()
      ->type_name(" ");
  add_report_file(reproducer, reproduce.report);
  reproducer.add_flag("--dry-run", reproduce.dry_run, "List the rows and the runs that stand for them");
  add_common(reproducer, reproduce.common);
}

void Parser::add_rest() {
  CLI::App& doctor_app = add(app, "doctor", kHelpDoctor, [this] { return Command(doctor); });
  add_common(doctor_app, doctor.common);
  CLI::App& helper = add(app, "help", kHelpHelp, [this] { return Command(help); });
  helper.add_option("TOPIC", help.topic, "The code of a message (C012), or a command")->type_name(" ");
  add_common(helper, help.common);
  CLI::App& completer = add(app, "completion", kHelpCompletion, [this] { return Command(completion); });
  completer.add_option("SHELL", completion.shell, "bash, zsh or fish")->required()->type_name(" ");
}

Parser::Parser() {
  app.set_help_flag("-h,--help", "This text");
  app.set_version_flag("--version", std::string("hwsim ") + HWSIM_VERSION);
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->column_width(34);
  app.formatter(formatter);
  app.require_subcommand(1);
  add_run();
  add_compare();
  add_explain();
  add_rank();
  add_sweep();
  add_optimize();
  add_report();
  add_reference();
  add_list_and_show();
  add_scene();
  add_gpu();
  add_config();
  add_rest();
  add_cache();
  add_calibration();
}

Command Parser::command() const {
  const CLI::App* chosen = &app;
  while (!chosen->get_subcommands().empty()) chosen = chosen->get_subcommands().front();
  return results_.at(chosen)();
}

/// `--reference` stands alone or before a number; CLI11 would take the scene for the number.
std::vector<std::string> with_explicit_values(int argc, const char* const* argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] != "--reference") continue;
    const bool number = i + 1 < words.size() && !words[i + 1].empty() &&
                        words[i + 1].find_first_not_of("0123456789") == std::string::npos;
    words[i] += "=" + (number ? words[i + 1] : std::to_string(kDefaultReferenceSamples));
    if (number) words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
  return words;
}

}  // namespace

Command parse_arguments(int argc, const char* const* argv) {
  const auto parser = std::make_unique<Parser>();
  const std::vector<std::string> words = with_explicit_values(argc, argv);
  if (std::ranges::find(words, std::string()) != words.end())  // CLI11 hangs on some of them
    fail_usage("U003", "an argument is empty", "", "leave it out, or look at the variable that it came from");
  const bool wants_text = !words.empty() && words.front().starts_with("-");
  if (!wants_text) check_command_names(parser->app, words);
  try {
    parser->app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them last first
  } catch (const CLI::CallForHelp&) {
    return PrintText{parser->app.help()};
  } catch (const CLI::CallForVersion& version) {
    return PrintText{std::string(version.what()) + "\n"};
  } catch (const CLI::ParseError& error) {
    fail_parse(error, parser->app, words);
  }
  return parser->command();
}

std::optional<std::string> help_text(std::string_view command) {
  Parser parser;
  std::vector<std::string> words = CLI::detail::split(std::string(command), ' ');
  const CLI::App& chosen = selected(parser.app, words);
  if (chosen.get_name() != words.back()) return std::nullopt;
  words.pop_back();
  return chosen.help("hwsim" + (words.empty() ? "" : " " + words.front()));
}

std::vector<CommandInfo> describe_commands() {
  Parser parser;
  std::vector<CommandInfo> commands;
  const auto add = [&commands](const CLI::App& app, const std::string& name) {
    commands.push_back({name, summary_of(app.get_description()), flags_of(app)});
  };
  for (const std::string& name : subcommand_names(parser.app)) {
    const CLI::App& app = selected(parser.app, {name});
    add(app, name);
    for (const std::string& sub : subcommand_names(app)) add(selected(app, {sub}), name + " " + sub);
  }
  return commands;
}

}  // namespace hwsim::cli
