// gyre view: finds the viewer, checks the file, serves both until Ctrl-C. See view.h.
#include "view/view.h"

#include "exit_code.h"
#include "interrupt.h"
#include "recording_file.h"
#include "scene/mesh_file.h"
#include "scene/scene_reader.h"
#include "scene/scene_writer.h"
#include "view/open_browser.h"
#include "view/view_server.h"

#include <gyre/replay.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace gyre {
namespace {

namespace fs = std::filesystem;

constexpr int kUsualPort = 8642;
constexpr const char* kBuilder = "tools/build_viewer.sh";
constexpr const char* kBuilderNeeds =
    " (it needs Node.js 20.19 or newer, npm and emscripten; with the word recordings behind it no "
    "emscripten, "
    "for a page that plays recordings only)";
// In the folder of a viewer that was built so (web/viewer/vite.config.ts).
constexpr const char* kWithoutEngine = "/without_engine.txt";

void say(const std::string& message) { std::fprintf(stderr, "gyre: %s\n", message.c_str()); }

bool is_viewer(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "index.html", error);
}

// The folder of the running program; empty if it cannot be known.
fs::path program_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path();
}

// Empty if there is none.
fs::path find_viewer() {
  if (const char* const given = std::getenv("GYRE_VIEWER"); given != nullptr && *given != 0) return given;
  const fs::path here = program_folder();
  // Installed: bin/gyre and share/gyre/viewer. Built: build/release/bin/gyre and web/viewer/dist; without the engine dist-recordings.
  for (const fs::path& folder : {here / "../share/gyre/viewer", here / "../../../web/viewer/dist",
                                 here / "../../../web/viewer/dist-recordings"}) {
    if (!here.empty() && is_viewer(folder)) return folder;
  }
  return {};
}

std::string page_without_viewer(const std::string& file_path) {
  std::string page =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Gyre</title>"
      "<style>body{font:1rem/1.5 system-ui,sans-serif;max-width:40rem;margin:4rem auto;padding:0 1rem}"
      "@media(prefers-color-scheme:dark){body{background:#181818;color:#ddd}a{color:#8ab4f8}}</style>"
      "<h1>The viewer is not built</h1><p>This gyre works, but the page that shows scenes is not there. In "
      "the source tree, "
      "<code>";
  page += std::string(kBuilder) + "</code> builds it" + kBuilderNeeds;
  page += "; then start <code>gyre view</code> again.</p>";
  if (!file_path.empty()) {
    page += "<p>The file itself: <a href=\"" + file_path + "\">" + file_path + "</a></p>";
  }
  return page + "</html>\n";
}

bool begins_like_a_recording(const std::string& path) {
  char begin[8] = {};
  std::ifstream(path, std::ios::binary).read(begin, sizeof begin);
  return std::string(begin, sizeof begin) == "GYREPLAY";
}

// Says what is wrong with it, and what will be missing.
bool check_recording(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<std::byte> bytes(std::size_t(file.tellg()));
  file.seekg(0).read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  const Result<PoseTrack> track = PoseTrack::open(bytes);
  if (track) {
    if (track->truncated()) {
      say(path + ": the recording was cut off or damaged; its first " + std::to_string(track->frame_count()) +
          " frames are whole");
    }
    return true;
  }
  const Result<Replay> replay = Replay::open(std::move(bytes));
  if (replay) return true;
  // The one that can say more about what was recorded.
  say(path + ": " + (track.error().code == ErrorCode::unsupported ? replay.error() : track.error()).message);
  return false;
}

// A scene made from a file of another program, or standard input, in a file that is there as long as it is served.
class ConvertedScene {
 public:
  ConvertedScene() = default;
  ConvertedScene(const ConvertedScene&) = delete;
  ConvertedScene& operator=(const ConvertedScene&) = delete;
  ~ConvertedScene() {
    std::error_code error;
    if (!folder_.empty()) fs::remove_all(folder_, error);
  }

  // The path of the scene; empty and a message if it cannot be made.
  std::string make(const std::string& path, const ImportOptions& import) {
    const SceneResult<Scene> scene = open_scene(path, import);
    if (!scene) {
      say(scene.error().text());
      return {};
    }
    for (const std::string& note : scene->notes) say(note);
    return keep(fs::path(path).filename().string() + ".gyre.json", write_scene(*scene, {.inline_meshes = true}));
  }
  // The path of a file with the bytes of standard input.
  std::string keep_input() {
    std::string bytes;
    const std::string problem = read_whole_file(std::string(kStandardInput), recording_limits(), bytes);
    if (!problem.empty()) {
      say("standard input: " + problem);
      return {};
    }
    return keep(bytes.rfind("GYREPLAY", 0) == 0 ? "input.gyrec" : "input.gyre.json", bytes);
  }

 private:
  // The path of a new file with these bytes; empty and a message if it cannot be made.
  std::string keep(const std::string& name, const std::string& bytes) {
    std::string folder = (fs::temp_directory_path() / "gyre_view_XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) {
      say(folder + ": cannot be made");
      return {};
    }
    folder_ = folder;
    const fs::path made = fs::path(folder_) / name;
    std::ofstream file(made, std::ios::binary);
    file << bytes;
    file.close();
    if (file) return made.string();
    say(made.string() + ": cannot be written");
    return {};
  }

  std::string folder_;
};

// Adds the file, and for a scene those that it names. False and a message if it cannot be shown.
bool add_shown(const std::string& path, const std::string& name, ServedFiles& files) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    say(path + (fs::is_directory(path, error) ? ": is a folder, expected a scene or a recording"
                                              : ": there is no such file"));
    return false;
  }
  if (begins_like_a_recording(path)) {
    if (!check_recording(path)) return false;
    files.add_recording("/files/" + name, path);
    return true;
  }
  const SceneResult<Scene> scene = load_scene(path);
  if (!scene) {
    say(scene.error().text());
    return false;
  }
  for (const SceneMesh& mesh : scene->meshes) {
    if (mesh.file.empty()) continue;
    files.add_file("/files/" + mesh.file, (fs::path(path).parent_path() / mesh.file).string());
  }
  files.add_file("/files/" + name, path);
  return true;
}

int bind(ViewServer& server, const ViewOptions& options) {
  if (options.port) {
    const int port = server.bind(*options.port);
    if (port < 0)
      say("port " + std::to_string(*options.port) +
          " of 127.0.0.1 is taken or may not be used; --port 0 finds a free one");
    return port;
  }
  const int usual = server.bind(kUsualPort);
  const int port = usual > 0 ? usual : server.bind(0);
  if (port < 0) say("no port of 127.0.0.1 can be had");
  return port;
}

}  // namespace

int view(const ViewOptions& options) {
  ServedFiles files;
  const fs::path viewer = options.viewer.empty() ? find_viewer() : fs::path(options.viewer);
  if (!options.viewer.empty() && !is_viewer(viewer)) {
    say(options.viewer + ": there is no viewer in this folder (no index.html)");
    return kExitInvalid;
  }
  if (!viewer.empty()) files.add_folder("/", viewer.string());
  std::string query, shown_path, shown_file = options.file;
  ConvertedScene converted;
  if (options.file == kStandardInput) {
    shown_file = converted.keep_input();
    if (shown_file.empty()) return kExitInvalid;
  } else if (format_of(options.file) != FileFormat::scene) {
    shown_file = converted.make(options.file, options.import);
    if (shown_file.empty()) return kExitInvalid;
  }
  const std::string name = fs::path(shown_file).filename().string();
  if (!options.file.empty()) {
    if (!add_shown(shown_file, name, files)) return kExitInvalid;
    shown_path = "/files/" + percent_encoded(name);
    query = "?file=" + shown_path;
  }
  const bool has_viewer = files.find("/index.html") != nullptr;
  if (!has_viewer)
    say(std::string("the viewer is not built, so there is little to see; this builds it: ") + kBuilder +
        kBuilderNeeds);
  if (files.find(kWithoutEngine) != nullptr && files.find_recording("/files/" + name) == nullptr)
    say("this viewer was built without the engine: it plays recordings and runs no scenes; in the source "
        "tree "
        "./run --live builds it with the engine");

  ViewServer server(std::move(files), page_without_viewer(shown_path));
  const int port = bind(server, options);
  if (port < 0) return kExitInvalid;
  watch_interrupt();
  server.start();
  const std::string address = "http://127.0.0.1:" + std::to_string(port) + "/" + query;
  std::printf("%s\n", address.c_str());
  std::fflush(stdout);
  if (!options.no_open) open_browser(address);
  say("serving it to this machine until Ctrl-C");
  while (!interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.stop();
  return kExitGood;
}

}  // namespace gyre
