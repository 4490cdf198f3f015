#include "study_command.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <set>

#include "talus/base/name.h"
#include "talus/base/parallel.h"
#include "talus/base/spawn.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/base/version.h"
#include "talus/model/read_model.h"
#include "talus/output/files.h"
#include "talus/results/histories.h"
#include "talus/run/branch.h"
#include "talus/schema/toml_source.h"
#include "talus/study/answers.h"
#include "talus/study/figures.h"
#include "talus/study/runner.h"
#include "talus/talus.h"
#include "tell.h"

namespace talus::app {

namespace fs = std::filesystem;

namespace {

volatile std::sig_atomic_t asked_to_stop = 0;
const std::string kProgram = fmt::format("talus {}", kVersion);

// Ctrl-C and kill: runs on the way are given up, and made anew when the study is started again. What is ignored stays so
// (nohup). While it exists.
class StopOnSignals {
 public:
  StopOnSignals() {
    struct sigaction action {};
    action.sa_handler = [](int signal) { asked_to_stop = signal; };  // no SA_RESTART: waiting is to end
    for (size_t k = 0; k < kSignals.size(); ++k) {
      sigaction(kSignals[k], nullptr, &before_[k]);
      if (before_[k].sa_handler != SIG_IGN) sigaction(kSignals[k], &action, nullptr);
    }
  }
  ~StopOnSignals() {
    for (size_t k = 0; k < kSignals.size(); ++k) sigaction(kSignals[k], &before_[k], nullptr);
  }
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

 private:
  static constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_{};
};

study::Study read(const std::string& file, const std::string& text) {
  Findings findings(file, text);
  study::Study found = study::read_study(file, text, findings);
  findings.throw_if_errors();
  if (findings.warning_count() > 0) tell(findings.render());
  return found;
}

// The study of a folder: its text, with paths from where it came from.
study::Study read(const study::StudyFolder& folder) {
  return read(folder.study_origin(), read_text_file(folder.study_file()));
}

// Which runs have static stages in common, that come first.
study::StudyFolder::Sharing sharing_of(const study::Study& s, const std::vector<study::PlannedRun>& plan,
                                       const Model& model) {
  study::StudyFolder::Sharing sharing;
  std::vector<std::string> begun;
  for (const StageInput& stage : model.stages) {
    if (stage.kind != StageKind::kStatic) break;
    begun.push_back(stage.name);
  }
  if (!s.share || begun.empty() || begun.size() == model.stages.size()) return sharing;
  const std::string text = read_text_file(s.model);
  // an axis is of the later part when another value of it changes nothing that came before
  std::vector<bool> later(s.axes.size());
  for (size_t a = 0; a < s.axes.size(); ++a) {
    std::vector<std::string> one = plan[0].overrides, other = one;
    const size_t at = s.set.size() + a;
    const auto different = std::find_if(
        plan.begin(), plan.end(), [&](const study::PlannedRun& r) { return r.overrides[at] != one[at]; });
    if (different == plan.end()) continue;
    other[at] = different->overrides[at];
    const ModelKeys now = keys_in_force(with_overrides(text, one)),
                    before = keys_in_force(with_overrides(text, other));
    const BranchKeys keys = branch_keys(now, before, begun, false, !model.bolts.empty());
    // what solves the steps tells in the stages before
    later[a] = keys.earlier.empty() &&
               std::none_of(keys.later.begin(), keys.later.end(), [](const KeyDifference& d) {
                 return d.key.rfind("solver.", 0) == 0 || d.key.rfind("stage.", 0) == 0;
               });
  }
  if (std::none_of(later.begin(), later.end(), [](bool l) { return l; })) return sharing;
  sharing.until = begun.back();
  for (const study::PlannedRun& run : plan) {
    std::vector<std::string> of_parent = plan[0].overrides;
    std::string name;
    for (size_t a = 0; a < s.axes.size(); ++a) {
      const size_t at = s.set.size() + a;
      if (later[a]) continue;
      of_parent[at] = run.overrides[at];
      name += run.overrides[at] + "\n";
    }
    sharing.group.push_back(text_hash(name));
    sharing.group_overrides.push_back(std::move(of_parent));
  }
  if (std::set<std::string>(sharing.group.begin(), sharing.group.end()).size() == plan.size()) return {};
  return sharing;
}

// Every value of every key in the first run, read and not cut: what is wrong with one is told before anything runs.
// The files that they read.
std::vector<std::string> check_values(const study::Study& s, const std::vector<study::PlannedRun>& plan,
                                      const std::string& text) {
  constexpr size_t kMost = 300;  // of an axis: of samples beyond it what is wrong is told by their runs
  std::vector<std::string> files;
  for (const study::Axis& axis : s.axes)
    for (const fs::path& path : axis.paths) files.push_back(path.string());
  for (size_t a = 0; a < s.axes.size(); ++a) {
    const size_t at = s.set.size() + a;
    std::set<std::string> seen{plan[0].overrides[at]};
    for (const study::PlannedRun& run : plan) {
      if (seen.size() > kMost || !seen.insert(run.overrides[at]).second) continue;
      std::vector<std::string> overrides = plan[0].overrides;
      overrides[at] = run.overrides[at];
      Findings findings(s.model.string(), text);
      const Model model = read_model(s.model.string(), text, overrides, findings);
      findings.throw_if_errors();
      for (const InputFile& input : model.files) files.push_back(input.path);
    }
  }
  return files;
}

// Whether each key that varies changes something of its own: two may name one key in two ways (stage.go, stage.0), and the
// last would hold for all runs.
void check_effects(const study::Study& s, const std::vector<study::PlannedRun>& plan,
                   const std::string& text) {
  Findings findings(s.file, s.text);
  for (size_t a = 0; a < s.axes.size(); ++a) {
    const size_t at = s.set.size() + a;
    const auto other = std::find_if(plan.begin(), plan.end(), [&](const study::PlannedRun& r) {
      return r.overrides[at] != plan[0].overrides[at];
    });
    if (other == plan.end()) continue;
    std::vector<std::string> overrides = plan[0].overrides;
    overrides[at] = other->overrides[at];
    const ModelKeys now = keys_in_force(with_overrides(text, overrides)),
                    before = keys_in_force(with_overrides(text, plan[0].overrides));
    const auto list = differences(now, before);
    if (list.empty())
      findings.error(s.axes[a].where, "vary." + s.axes[a].name,
                     "changes nothing: another key that varies, or set, has the last word",
                     "name a key in one way, once");
  }
  findings.throw_if_errors();
}

void show_progress(const study::Progress& p, bool terminal, bool quiet) {
  static double last = -1e9;
  const double now = wall_now();
  if (quiet || (p.done < p.all && now - last < (terminal ? 0.2 : 10))) return;
  last = now;
  const std::string to_go = p.to_go > 0 ? fmt::format(", {} to go", readable_seconds(p.to_go)) : "";
  const std::string not_done = p.not_done > 0 ? fmt::format(", {} not done", p.not_done) : "";
  fmt::print("{}  {} of {} done, {} running, {} not valid or refused{}{}{}", terminal ? "\r\x1b[K" : "",
             p.done, p.all, p.running, p.without, not_done, to_go, terminal ? "" : "\n");
  if (terminal && p.running == 0) fmt::print("\n");
  std::fflush(stdout);
}

int run_here(const study::StudyFolder& folder, const study::Study& s, const std::vector<int>& numbers,
             int jobs, bool quiet) {
  folder.clean();
  const StopOnSignals signals;
  study::Runner runner(folder, {own_program(), kProgram, jobs, s.keep_all, s.report});
  const bool terminal = isatty(fileno(stdout)) != 0;
  const study::Progress end = runner.run(
      numbers, [&](const study::Progress& p) { show_progress(p, terminal, quiet); },
      [] { return asked_to_stop != 0; });
  if (asked_to_stop != 0) return kExitSignal + asked_to_stop;
  if (end.not_done == 0) return kExitOk;
  tell("talus: {} runs are not done, and made again by the same command; {}\n", end.not_done, end.cause);
  return kExitUnfinished;
}

// The runs of a study that was begun, in the order of their numbers.
std::vector<study::PlannedRun> planned(const study::Study& s, const study::StudyFolder& folder) {
  std::vector<study::PlannedRun> plan = study::plan_runs(s);
  if (const int unknown = folder.number(s, plan); unknown > 0)
    tell("talus: note: {} runs of the study file are not in {} yet: talus study {} -o {} adds them\n",
         unknown, folder.path().string(), folder.study_origin(), folder.path().string());
  std::sort(plan.begin(), plan.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  return plan;
}

int gather(const study::StudyFolder& folder, const study::Study& s, bool quiet) {
  const study::Gathered found = study::gather(s, planned(s, folder), folder);
  study::write_results(s, found, folder);
  if (!quiet)
    show("{}written to {}: results.csv, study.html, figures/\n", study::gathered_text(s, found),
         folder.path().string());
  return found.of(study::Outcome::kNotDone) > 0 ? kExitUnfinished : kExitOk;
}

// What a program prints; "" when it cannot be run.
std::string output_of(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return "";
  std::string out;
  char part[4096];
  for (size_t n; (n = std::fread(part, 1, sizeof(part), pipe)) > 0;) out.append(part, n);
  const int status = pclose(pipe);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? out : "";
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// A path in a line of #SBATCH: in quotes, and no pattern. Throws FileError where Slurm cannot carry it.
std::string for_sbatch(const std::string& path) {
  std::string out = "\"";
  for (const char c : path) {
    if (c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ' || c == 127)
      throw FileError(fmt::format(
          "{}: a script for Slurm cannot name it: quotes, backslashes and control characters. Take another folder",
          shown_name(path)));
    out += c == '%' ? std::string("%%") : std::string(1, c);
  }
  return out + '"';
}

int submit_to_slurm(const study::StudyFolder& folder, const StudyArguments& args) {
  constexpr int kDefaultArray = 1001;  // of Slurm
  int most = kDefaultArray;
  const std::string config = output_of("scontrol show config 2>/dev/null");
  if (const size_t at = config.find("MaxArraySize"); at != std::string::npos)
    most = std::max(2, std::atoi(config.c_str() + config.find('=', at) + 1));
  const int all = folder.planned(), elements = std::min(all, most - 1),
            pack = (all + elements - 1) / elements;
  const int used = (all + pack - 1) / pack;
  const fs::path root = fs::absolute(folder.path()).lexically_normal();
  std::string script = "#!/bin/sh\n# runs of a study, " +
                       fmt::format("{} to an element; those that are done are passed over\n", pack);
  std::string output = for_sbatch(folder.begun("slurm-").string());
  output.insert(output.size() - 1, "%A_%a.txt");
  script += fmt::format("#SBATCH --array=0-{}\n#SBATCH --requeue\n#SBATCH --output={}\n", used - 1, output);
  script += fmt::format("exec {} study task {} $((SLURM_ARRAY_TASK_ID * {})) --count {}\n",
                        quoted(own_program()), quoted(root.string()), pack, pack);
  write_file(root / "slurm.sh", script);
  const std::string said =
      output_of(fmt::format("sbatch --parsable {} {}", args.sbatch, quoted((root / "slurm.sh").string())));
  if (said.empty())
    throw FileError(
        fmt::format("sbatch could not be run, or refused {}/slurm.sh; its message is above", root.string()));
  show("job {}: {} runs in {} array elements of {}\nwhen they have ended, or before: talus study gather {}\n",
       said.substr(0, said.find_first_of("\r\n;")), all, used, pack, folder.path().string());
  return kExitOk;
}

int begin_study(const StudyArguments& args) {
  if (args.file.empty() || args.folder.empty())
    throw Error(
        kExitUsage,
        "study needs STUDY.toml and -o FOLDER; talus study task and talus study gather need the folder");
  const study::Study s = read(args.file, read_text_file(args.file));
  std::vector<study::PlannedRun> plan = study::plan_runs(s);
  // the first run as it will be: what is wrong with the model, or with names in formulas, is told before anything runs
  const std::string text = read_text_file(s.model), model_file = s.model.string();
  Findings of_model(model_file, text);
  const PreparedRun first = prepare_run(model_file, text, plan[0].overrides, of_model);
  if (of_model.warning_count() > 0 && !args.quiet) tell(of_model.render());
  Findings of_study(args.file, s.text);
  std::vector<std::string> stages;
  for (const StageInput& stage : first.scene.model.stages) stages.push_back(stage.name);
  study::check_formulas(s,
                        study::possible_numbers(texts_of(Histories(first.scene, nullptr).answers().titles()),
                                                stages, first.scene.layout.origins),
                        of_study);
  of_study.throw_if_errors();

  std::vector<std::string> files = check_values(s, plan, text);
  check_effects(s, plan, text);
  if (args.dry) {
    show("{} runs of {}, {} blocks each; the first:\n", plan.size(), model_file, first.scene.blocks.count);
    for (const std::string& item : plan[0].overrides) show("  --set {}\n", item);
    return kExitOk;
  }
  files.push_back(model_file);
  for (const InputFile& input : first.scene.model.files) files.push_back(input.path);
  study::StudyFolder folder(args.folder);
  folder.begin(s, plan, sharing_of(s, plan, first.scene.model), kProgram, files);
  if (args.plan) {
    show("{}: {} runs are planned; talus study task {} K makes one\n", args.folder, plan.size(), args.folder);
    return kExitOk;
  }
  if (args.on == "slurm") return submit_to_slurm(folder, args);
  std::vector<int> numbers;
  for (int k = 0; k < folder.planned(); ++k) numbers.push_back(k);
  const int code = run_here(folder, s, numbers, args.jobs > 0 ? args.jobs : processors(), args.quiet);
  if (code == kExitOk || code == kExitUnfinished) return gather(folder, s, args.quiet);
  tell("talus: stopped; the same command goes on with what is missing\n");
  return code;
}

}  // namespace

void add_study_arguments(CLI::App& verb, StudyArguments& args) {
  verb.add_option("STUDY", args.file, "study file (TOML)");
  verb.add_option("-o,--output", args.folder, "folder of the study; one that was begun goes on");
  verb.add_option("--jobs", args.jobs, "runs side by side, 0: one for each processor")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  verb.add_option("--on", args.on, "batch system that the runs are handed to")
      ->check(CLI::IsMember({"slurm"}));
  verb.add_option("--sbatch", args.sbatch,
                  "with --on slurm: options for sbatch, \"--partition=long --time=2:00:00\"");
  verb.add_flag("--dry-run", args.dry, "check study and model, say how many runs, and write nothing");
  verb.add_flag("--plan", args.plan, "begin the folder and run nothing, for talus study task");
  verb.add_flag("-q,--quiet", args.quiet, "say nothing but errors");
  args.task = verb.add_subcommand("task", "run planned runs of a study that was begun, for batch systems");
  args.task->add_option("DIR", args.folder, "folder of the study")->required();
  args.task->add_option("K", args.first, "number of the run, from 0")
      ->required()
      ->check(CLI::Range(0, 100000000));
  args.task->add_option("--count", args.count, "so many from there on; those that are done are passed over")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  args.task->footer("Example: seq 0 899 | parallel talus study task out/walls {}");
  args.gather = verb.add_subcommand("gather", "collect what is done: results.csv, figures, study.html");
  args.gather->add_option("DIR", args.folder, "folder of the study")->required();
  args.gather->add_flag("-q,--quiet", args.quiet, "say nothing but errors");
  args.gather->footer("Example: talus study gather out/walls");
  verb.footer("Example: talus study examples/many_runs/friction.toml -o out/friction");
}

bool is_study_folder(const std::string& folder) { return is_there(fs::path(folder) / "study.json"); }

int report_of_study(const std::string& name, const std::function<void(const std::string& run)>& make) {
  const study::StudyFolder folder(name);
  folder.check(kProgram);
  const study::Study s = read(folder);
  int made = 0;
  for (int k = 0; k < folder.planned(); ++k) {
    const fs::path run = folder.run_folder(k);
    const auto record = folder.record_of(k);
    if (!record || !is_there(run / "histories.csv") || is_there(run / "report.html")) continue;
    make(run.string());
    ++made;
  }
  if (made > 0) show("reports of {} runs made\n", made);
  if (!s.keep_all) show("runs keep their answers alone (keep = \"answers\"): they have no reports\n");
  return gather(folder, s, false);
}

int study_command(const StudyArguments& args) {
  if (!*args.task && !*args.gather) return begin_study(args);
  const study::StudyFolder folder(args.folder);
  folder.check(kProgram);
  const study::Study s = read(folder);
  if (*args.gather) return gather(folder, s, args.quiet);
  std::vector<int> numbers;
  for (int k = args.first; k < args.first + args.count && k < folder.planned(); ++k) numbers.push_back(k);
  if (numbers.empty())
    throw Error(kExitUsage,
                fmt::format("there is no run {}; runs are 0 to {}", args.first, folder.planned() - 1));
  return run_here(folder, s, numbers, 1, true);
}

}  // namespace talus::app
