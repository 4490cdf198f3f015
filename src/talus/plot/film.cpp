#include "talus/plot/film.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "talus/base/error.h"
#include "talus/base/spawn.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"

namespace talus::plot {

namespace fs = std::filesystem;

namespace {

// A folder that goes with its content.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "talus_film_XXXXXX").string();
    if (!mkdtemp(name.data())) throw FileError(name + ": no folder for the frames of a film can be made");
    path = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  fs::path path;
};

}  // namespace

void write_film(const std::vector<std::string>& frames, double seconds, const fs::path& path) {
  const Scratch scratch;
  for (size_t k = 0; k < frames.size(); ++k)
    write_file(scratch.path / fmt::format("frame_{:06}.png", k), frames[k]);
  const std::string rate = fmt::format("{:.6g}", 1 / seconds),
                    pattern = (scratch.path / "frame_%06d.png").string(),
                    said = (scratch.path / "said").string(), film = (scratch.path / "film.mp4").string();
  // even numbers of pixels and this kind of colour are what players know
  std::array<std::string, 14> words{
      "ffmpeg",   "-nostdin", "-loglevel", "error", "-framerate",
      rate,       "-i",       pattern,     "-vf",   "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
      "-pix_fmt", "yuv420p",  "-y",        film};
  pid_t child = 0;
  try {
    child = spawn({words.begin(), words.end()}, said);
  } catch (const FileError&) {
    throw FileError(fmt::format(
        "{}: a film takes ffmpeg, which is not there: install it, or give a name that ends in .png",
        path.string()));
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw FileError(fmt::format("{}: ffmpeg failed: {}", path.string(), read_text_file(said)));
  write_file(path, read_text_file(film));
}

}  // namespace talus::plot
