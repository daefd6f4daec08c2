#include "common/cli/film.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <numbers>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/files/unique_fd.h"
#include "common/base/quantile.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/render/png.h"
#include "common/render/render_image.h"

namespace palpate {
namespace {

constexpr const char* kProgram = "ffmpeg";

bool is_film(const std::filesystem::path& out) {
  return out.extension() == ".mp4" || out.extension() == ".webm";
}

int frame_count(const Document& options) {
  return std::max(options.output.turntable, options.output.path_frames);
}

/// "turn-0001.png"; the first one is 1.
std::filesystem::path frame_file(const std::filesystem::path& out, int frame, int count) {
  constexpr std::size_t kLeastDigits = 4;
  const std::size_t digits = std::max(kLeastDigits, std::to_string(count).size());
  std::string number = std::to_string(frame);
  number.insert(0, digits - std::min(digits, number.size()), '0');
  std::filesystem::path file = out;
  return file.replace_filename(out.stem().string() + "-" + number + out.extension().string());
}

bool is_installed(const std::string& program) {
  const char* const folders = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  if (folders == nullptr) return false;
  return std::ranges::any_of(split(folders, ':'), [&](std::string_view folder) {
    return ::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0;
  });
}

/// The way to show all of `view` from a part of a turn on, about the upright axis of the data.
void turn_table(Camera& camera, double part) {
  const double angle = 2.0 * std::numbers::pi * part, c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < 3; ++i) {
    Vec3& axis = camera.axes[i];
    axis = {c * axis.x - s * axis.y, s * axis.x + c * axis.y, axis.z};
  }
}

/// Frames in, a film out: a running ffmpeg.
class Encoder {
 public:
  /// @param out is there once finish() has come back; nothing is where it did not.
  Encoder(const std::filesystem::path& out, const Image& first, double rate, InterruptGuard& interrupt)
      : out_(out), unfinished_(out) {
    unfinished_.replace_filename("." + out.filename().string() + "." + std::to_string(::getpid()) + ".part");
    interrupt.unfinished(unfinished_);
    std::array<int, 2> ends{-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      refuse("cannot be given pictures");
    frames_.reset(ends[0]);
    const UniqueFd theirs(ends[1]);
    std::vector<std::string> words{
        kProgram,   "-loglevel",
        "error",    "-y",
        "-f",       "rawvideo",
        "-pix_fmt", "rgba",
        "-s",       std::to_string(first.width) + "x" + std::to_string(first.height),
        "-r",       exact_number(rate),
        "-i",       "pipe:0",
        "-an",      "-vf",
        kEven,      "-pix_fmt",
        "yuv420p",  "-c:v"};
    for (const char* word : out.extension() == ".webm" ? kWebm : kMp4) words.emplace_back(word);
    words.push_back("file:" + unfinished_.string());  // whatever colons it has
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files{};
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, theirs.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, STDERR_FILENO, STDOUT_FILENO);  // ours is for results
    const int error = ::posix_spawnp(&child_, kProgram, &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) refuse(std::string("cannot be started: ") + std::strerror(error));
  }
  ~Encoder() {
    frames_.reset();
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
    std::error_code none_there;
    std::filesystem::remove(unfinished_, none_there);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  void add(const Image& image) {
    for (std::size_t sent = 0; sent < image.rgba.size();) {
      const ssize_t count =
          ::send(frames_.get(), image.rgba.data() + sent, image.rgba.size() - sent, MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) refuse("has ended before the film did; what it said is above");
      sent += static_cast<std::size_t>(count);
    }
  }
  void finish() {
    frames_.reset();
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) refuse("has made no film; what it said is above");
    std::filesystem::rename(unfinished_, out_);
  }

 private:
  // Most players want an even number of pixels.
  static constexpr const char* kEven = "pad=ceil(iw/2)*2:ceil(ih/2)*2";
  static constexpr std::array<const char*, 7> kMp4{"libx264",    "-crf", "18", "-movflags",
                                                   "+faststart", "-f",   "mp4"};
  static constexpr std::array<const char*, 7> kWebm{"libvpx-vp9", "-crf", "24", "-b:v", "0", "-f", "webm"};

  [[noreturn]] void refuse(const std::string& what) const {
    throw work_error(out_.string() + ": " + kProgram + " " + what);
  }

  std::filesystem::path out_, unfinished_;
  UniqueFd frames_;
  pid_t child_ = -1;
};

}  // namespace

bool asks_for_film(const Document& options) noexcept { return frame_count(options) > 0; }

void check_film(const Document& options, std::size_t pictures, int panes) {
  const OutputOptions& output = options.output;
  if (output.path_frames > 0 && options.hand.path.empty())
    throw usage_error("--path-frames needs the path of a hand: --path FILE.csv");
  if (output.turntable > 0 && output.path_frames > 0 && output.turntable != output.path_frames)
    throw usage_error("--turntable " + std::to_string(output.turntable) + " and --path-frames " +
                      std::to_string(output.path_frames) +
                      " are one film: give both the same number of pictures");
  if (pictures > 1 || !options.hand.workbench.empty())
    throw usage_error("films are for a desktop: leave out --workbench, or --turntable and --path-frames");
  if (panes > 1) throw usage_error("films are of the scene alone: ask for --layout 1");
  if (output.repeat > 0 || options.view.frame_budget > 0.0)
    throw usage_error("--repeat and --frame-budget are of one picture: leave them out for a film");
  if (is_film(output.file)) {
    if (!is_installed(kProgram)) {
      throw work_error(output.file.string() + ": films are made by the program " + kProgram +
                       ", which is not installed: install it, or give --out " +
                       std::filesystem::path(output.file).replace_extension(".png").string() +
                       " for numbered pictures");
    }
    check_output(output.file, options.common.force);
    return;
  }
  for (int frame = 1; frame <= frame_count(options); ++frame)
    check_output(frame_file(output.file, frame, frame_count(options)), options.common.force);
}

void draw_film(const DrawnScene& drawn, const Document& options, const VerbContext& context, int width,
               int height, RenderSummary& summary) {
  const std::filesystem::path& out = options.output.file;
  const int count = frame_count(options);
  std::unique_ptr<Encoder> encoder;
  ImageSequence pictures;
  std::vector<double> milliseconds;
  context.progress.begin("drawing", static_cast<std::uint64_t>(count));
  SceneView view = drawn.view;
  for (int frame = 0; frame < count; ++frame) {
    context.progress.check();
    view.camera = drawn.view.camera;
    if (options.output.turntable > 0) turn_table(view.camera, static_cast<double>(frame) / count);
    if (options.output.path_frames > 0 && drawn.hand) {
      ProbeView hand = drawn.hand(static_cast<double>(frame) / (count - 1));
      hand.reference_speed = drawn.view.probe->reference_speed;
      hand.drawn_lines = drawn.view.probe->drawn_lines;
      view.probe = std::move(hand);
    }
    const Image image = pictures.draw(view, width, height);
    milliseconds.push_back(pictures.milliseconds());
    summary.width = image.width;
    summary.height = image.height;
    if (is_film(out)) {
      if (!encoder)
        encoder = std::make_unique<Encoder>(out, image, options.output.frame_rate, context.interrupt);
      encoder->add(image);
    } else {
      const std::filesystem::path file = frame_file(out, frame + 1, count);
      write_png(file, image,
                {{"Software", version_text(context.explorer.name)}, {"Command", context.command_line}});
      context.interrupt.keep(file);
    }
    context.progress.advance();
  }
  summary.output = frame_file(out, 1, count).string();
  if (encoder) {
    encoder->finish();
    context.interrupt.keep(out);
    summary.output = out.string();
  }
  summary.frames = count;
  summary.frame_rate = options.output.frame_rate;
  summary.renderer = pictures.renderer();
  summary.first_frame_ms = milliseconds.front();
  summary.frames_timed = count;
  summary.frame_ms = median(milliseconds);
  context.console.print(summary.input + ": " + drawn.what + " -> " + std::to_string(count) + " pictures, " +
                        summary.output + (encoder ? "" : " to " + frame_file(out, count, count).string()) +
                        " (" + std::to_string(width) + " x " + std::to_string(height) + ", " +
                        short_number(std::round(summary.frame_ms)) + " ms a frame, " + summary.renderer +
                        ")\n");
}

}  // namespace palpate
