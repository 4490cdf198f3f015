#include "record_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "help.h"
#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/output/result_folder.h"
#include "talus/plot/record_figures.h"
#include "talus/record/measures.h"
#include "talus/record/motion_file.h"
#include "talus/record/section.h"
#include "tell.h"

namespace talus::app {

namespace {

const std::map<std::string, record::Format> kFormats{
    {"peer", record::Format::kPeer},   {"knet", record::Format::kKnet},
    {"jma", record::Format::kJma},     {"csv", record::Format::kCsv},
    {"esm", record::Format::kEsm},     {"geonet", record::Format::kGeonet},
    {"csmip", record::Format::kCsmip}, {"cosmos", record::Format::kCosmos},
    {"smc", record::Format::kSmc}};

// What the command made, ready to be written.
struct Outcome {
  record::Motion motion;
  std::optional<record::Motion> before;
  std::optional<record::TargetSpectrum> target;
  record::Account account;
  std::string title;
  bool as_read = false;  // nothing was done to it
};

// The motion along the section from this component and the other one.
std::vector<double> with_second(const RecordArguments& args, record::ReadOptions read,
                                const record::Record& first, std::vector<double> acceleration, Outcome& out) {
  const std::string file = args.second.empty() ? args.file : args.second;
  read.column = args.second_column;
  const record::Record other = record::read_record_text(file, record::read_record_file(file), read);
  if (std::abs(other.dt - first.dt) > 1e-6 * first.dt)
    throw InputError(
        fmt::format("{}: its step is {:g} s, that of {} {:g} s: the two components must have the same", file,
                    other.dt, args.file, first.dt));
  if (other.value.size() != first.value.size())
    tell("talus: note: {} has {} values, {} {}: what one has more is left out\n", args.file,
         first.value.size(), file, other.value.size());
  out.account.steps.push_back(
      {fmt::format("with {}, \"{}\", to the azimuth of the section", file, other.title),
       {{"azimuth [deg]", args.azimuths[0]},
        {"azimuth of the other [deg]", args.azimuths[1]},
        {"azimuth of the section [deg]", args.section}}});
  show("{}: {}, \"{}\"; along the section at {:g} deg\n", file, name_of(other.format), other.title,
       args.section);
  return record::along_section(acceleration, args.azimuths[0], record::acceleration_of(other),
                               args.azimuths[1], args.section);
}

Outcome from_file(const RecordArguments& args) {
  record::ReadOptions read = args.read;
  if (!args.format.empty()) read.format = kFormats.at(args.format);
  if (args.dt > 0) read.dt = args.dt;
  const std::string text = record::read_record_file(args.file);
  const record::Record r = record::read_record_text(args.file, text, read);
  Outcome out;
  out.account = {.source = args.file,
                 .hash = text_hash(text),
                 .format = std::string(name_of(r.format)),
                 .title = r.title,
                 .unit = r.unit,
                 .offset = r.offset};
  out.title = std::filesystem::path(args.file).filename().string();
  std::vector<double> acceleration = record::acceleration_of(r);
  if (args.to_section) acceleration = with_second(args, read, r, std::move(acceleration), out);
  out.before = record::integrate(acceleration, r.dt);
  if (r.quantity != record::Quantity::kAcceleration)
    out.account.steps.push_back(
        {fmt::format("acceleration by differences of the {}", name_of(r.quantity)), {}});
  const bool asked = std::any_of(args.step_options.begin(), args.step_options.end(),
                                 [](const CLI::Option* option) { return option->count() > 0; });
  if (!r.processed.empty()) {
    tell("talus: note: {} is processed already: {}; {}\n", args.file, r.processed,
         args.raw || !asked ? "it is taken as it is, as with --raw; any option of a step processes it again"
                            : "it is processed once more, as asked for");
    out.account.steps.push_back({"processed before: " + r.processed, {}});
  }
  out.as_read = args.raw || (!r.processed.empty() && !asked);
  if (out.as_read) {
    out.motion = *out.before;
  } else {
    record::Processing how = args.how;
    if (args.corner == "-6dB") how.band.corner = record::Corner::k6dB;
    record::Processed done = record::process(out.before->acceleration, r.dt, how, args.file);
    out.motion = std::move(done.motion);
    out.account.steps.insert(out.account.steps.end(), done.steps.begin(), done.steps.end());
  }
  show("{}: {}, \"{}\", {} values in {}, dt = {:g} s, {:g} s\n", args.file, name_of(r.format), r.title,
       r.value.size(), r.unit, r.dt, out.before->duration());
  return out;
}

Outcome from_seed(const RecordArguments& args) {
  record::SyntheticInput in = args.make;
  if (args.dt > 0) in.dt = args.dt;
  if (args.how.duration > 0) in.duration = args.how.duration;
  if (args.pga > 0) in.pga = args.pga;
  if (!args.target.empty())
    in.target = record::read_target(args.target);
  else if (in.pga)
    in.target = record::code_spectrum(*in.pga);
  record::Synthetic made = record::make_synthetic(in);
  Outcome out;
  out.motion = std::move(made.motion);
  out.target = in.target;
  out.title = fmt::format("synthetic motion, seed {}", in.seed);
  out.account.source = out.title;
  out.account.steps = made.steps;
  show("{}: {:g} s in steps of {:g} s, rms of ln(Sa / target) {:.3f} at {} periods\n", out.title, in.duration,
       in.dt, made.rms_misfit, record::matched_periods(in).size());
  return out;
}

// What only a file has: its format, and steps that a synthetic motion does not go through.
std::vector<CLI::Option*> add_file_options(CLI::App& verb, RecordArguments& args) {
  return {
      verb.add_option("--format", args.format, "format of the file; without: known from its content")
          ->check(CLI::IsMember({"peer", "knet", "jma", "csv", "esm", "geonet", "csmip", "cosmos", "smc"})),
      verb.add_option("--column", args.read.column,
                      "column or component: its title, or acceleration, velocity, displacement"),
      verb.add_option("--unit", args.read.unit,
                      "unit of the values where the file names none: " + record::known_units()),
      verb.add_option(
          "--second", args.second,
          "file of the other horizontal component; without, but with --second-column: the same file"),
      verb.add_option("--second-column", args.second_column, "column or component of the other one"),
      verb.add_option("--azimuths", args.azimuths, "azimuths of both components, clockwise from north [deg]")
          ->expected(2),
      verb.add_option("--section", args.section,
                      "azimuth of the section's x [deg]: the motion along it is made of both"),
      verb.add_flag("--raw", args.raw, "convert to SI and integrate only; none of the steps below")};
}

std::vector<CLI::Option*> add_step_options(CLI::App& verb, RecordArguments& args) {
  record::Processing& how = args.how;
  return {
      verb.add_option("--pre-event", how.pre_event, "take the mean of the first so many seconds; 0: of all")
          ->capture_default_str(),
      verb.add_option("--taper", how.taper, "share of the samples that a cosine raises at each end")
          ->capture_default_str(),
      verb.add_option("--high-pass", how.band.high_pass,
                      "corner below which motion is taken out [Hz]; 0: none")
          ->capture_default_str(),
      verb.add_option("--low-pass", how.band.low_pass, "corner above which motion is taken out [Hz]; 0: none")
          ->capture_default_str(),
      verb.add_option("--order", how.band.order,
                      "order n of the whole zero-phase Butterworth filter: slopes of n x 6 dB per octave")
          ->capture_default_str(),
      verb.add_option(
              "--corner", args.corner,
              "gain at the corners: -3dB, |H| = 1/sqrt(1 + (f1/f)^(2n)); or -6dB, as a filter of order n/2 "
              "run forwards and backwards, 1/(1 + (f1/f)^n)")
          ->check(CLI::IsMember({"-3dB", "-6dB"}))
          ->capture_default_str(),
      verb.add_option("--baseline", how.baseline_degree,
                      "degree of the polynomial t^2 ... taken off the displacement; 0: none")
          ->capture_default_str(),
      verb.add_option("--begin", how.begin, "begin of the window [s]")->capture_default_str(),
      verb.add_option("--end-taper", how.end_taper, "length of the cosine at the end of the window [s]")
          ->capture_default_str()};
}

std::vector<CLI::Option*> add_synthetic_options(CLI::App& verb, RecordArguments& args) {
  record::Envelope& envelope = args.make.envelope;
  return {verb.add_option("--seed", args.make.seed, "seed of the random phases")->capture_default_str(),
          verb.add_option("--pga", args.pga, "peak acceleration of the synthetic motion [m/s2]")
              ->check(above_zero()),
          verb.add_option(
              "--target", args.target,
              "CSV \"period [s],sa [m/s2]\" to match; without: the code spectrum of docs/theory.md (11.6) "
              "for --pga"),
          verb.add_option("--rise", envelope.rise, "envelope: seconds of (t/rise)^2")->capture_default_str(),
          verb.add_option("--strong", envelope.strong, "envelope: seconds of full strength")
              ->capture_default_str(),
          verb.add_option("--decay", envelope.decay, "envelope: seconds in which it falls to 5 %")
              ->capture_default_str()};
}

}  // namespace

void add_record_arguments(CLI::App& verb, RecordArguments& args) {
  verb.add_option(
      "FILE", args.file,
      "PEER AT2, VT2, DT2; K-NET or KiK-net; JMA; ESM or ITACA ASC; GeoNet V2A; CSMIP V2; COSMOS V1, V2; SMC; or a table");
  verb.add_option("-o,--out,--output", args.folder, "folder for motion.csv, record.json and the figures")
      ->required();
  verb.add_flag("--force", args.force, "replace the results in that folder");
  verb.add_option("--dt", args.dt, "time step [s], where the file has none; of a synthetic motion: 0.01")
      ->check(above_zero());
  verb.add_option("--duration", args.how.duration,
                  "length of the window [s], 0: to the end; of a synthetic motion: 20")
      ->check(not_negative());
  CLI::Option* synthetic =
      verb.add_flag("--synthetic", args.synthetic, "make a motion from a seed instead of reading one");
  // an option that would do nothing is refused
  const auto of_file = add_file_options(verb, args), of_steps = add_step_options(verb, args);
  args.step_options.assign(of_steps.begin(), of_steps.end());
  for (CLI::Option* o : of_file) o->excludes(synthetic);
  for (CLI::Option* o : of_steps) o->excludes(synthetic)->excludes(of_file.back());
  for (CLI::Option* o : add_synthetic_options(verb, args)) o->needs(synthetic);
  verb.footer(
      "Steps: mean, taper, filter, baseline, window, end brought to rest (v = d = 0). g = 9.80665 m/s2.\n"
      "Example: talus record KOBE000.AT2 --low-pass 15 --duration 20 --out out/kobe\n"
      "         talus record --synthetic --seed 50 --pga 8.17 --out out/synthetic");
}

int record_command(const RecordArguments& given) {
  RecordArguments args = given;
  args.to_section = !args.second.empty() || !args.second_column.empty() || !args.azimuths.empty();
  if (args.to_section && (args.azimuths.size() != 2 || (args.second.empty() && args.second_column.empty())))
    throw Error(
        kExitUsage,
        "talus record: the motion along a section takes --second FILE or --second-column, --azimuths of both, and --section");
  if (args.synthetic != args.file.empty())
    throw Error(kExitUsage, args.synthetic ? "talus record: give FILE or --synthetic, not both"
                                           : "talus record: give FILE, or --synthetic with --seed and --pga");
  Outcome out = args.synthetic ? from_seed(args) : from_file(args);
  record::Account& account = out.account;
  account.after = record::measure(out.motion);
  record::check_finite(out.title, out.motion, account.after);
  account.samples = out.motion.size();
  account.dt = out.motion.dt;
  std::vector<std::pair<std::string, record::Measures>> columns;
  std::vector<plot::MotionCurve> curves;
  if (out.before && !out.as_read) {
    account.before.push_back(record::measure(*out.before));
    record::check_finite(out.title, *out.before, account.before[0]);
    columns.emplace_back("as read", account.before[0]);
    curves.push_back({"as read", &*out.before});
  }
  const char* made = args.synthetic ? "synthetic" : out.as_read ? "as read" : "processed";
  columns.emplace_back(made, account.after);
  curves.push_back({made, &out.motion});
  show("{}", record::measures_table(columns));

  ResultFolder folder(args.folder, args.force, ResultKind::kRecord);
  folder.write("record.json", record::record_json(account));
  folder.write("motion.csv", record::motion_csv(out.motion));
  folder.write("spectrum.csv", record::spectrum_csv(out.motion));
  for (const char* figure : {"acceleration", "velocity", "displacement", "spectrum"})
    folder.note_picture(figure);
  plot::write_record_figures(out.title, curves, out.target ? &*out.target : nullptr, folder.path());
  show(
      "written to {}: motion.csv (for [history.NAME] file and column), spectrum.csv, record.json, acceleration, velocity, "
      "displacement and spectrum as .svg and .png\n",
      args.folder);
  return kExitOk;
}

}  // namespace talus::app
