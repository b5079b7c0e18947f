// gyre view as a browser and as somebody with bad intentions see it: requests byte by byte.
#include "run_program.h"

#include <gyre/track.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace gyre::view_test {
namespace {

namespace fs = std::filesystem;

const std::string kScene =
    R"({"gyre_scene": 1, "name": "small", "meshes": {"tile": {"file": "parts/tile.obj"}},
  "bodies": [{"name": "ground", "type": "static", "shapes": [{"type": "mesh", "mesh": "tile"}]},
  {"name": "box", "position": [0, 2, 0], "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.5]}]}]})";
const std::string kTile = "v -5 0 -5\nv 5 0 -5\nv 5 0 5\nv -5 0 5\nf 1 3 2\nf 1 4 3\n";

// A running `gyre view`, ended by Ctrl-C.
class RunningView {
 public:
  RunningView(const std::vector<std::string>& arguments, const fs::path& folder, const char* input = "/dev/null") {
    const std::string program = program_path();
    std::vector<std::string> all = {program, "view"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& argument : all) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const std::string err = (folder / "view.err").string();
    int out[2];
    if (pipe(out) != 0) return;
    child_ = fork();
    if (child_ == 0) {
      const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      dup2(out[1], 1);
      dup2(err_file, 2);
      close(out[0]);
      unsetenv("DISPLAY");
      unsetenv("WAYLAND_DISPLAY");
      unsetenv("GYRE_VIEWER");
      if (chdir(folder.c_str()) != 0) _exit(125);
      dup2(open(input, O_RDONLY), 0);
      execv(program.c_str(), argv.data());
      _exit(126);
    }
    close(out[1]);
    // The first line is the address; there is none if it ends at once.
    char c = 0;
    while (read(out[0], &c, 1) == 1 && c != '\n') address += c;
    close(out[0]);
    const std::size_t colon = address.rfind(':');
    if (colon != std::string::npos) port = std::atoi(address.c_str() + colon + 1);
  }
  ~RunningView() { finish(); }

  // The exit status.
  int finish() {
    if (child_ <= 0) return code_;
    if (port != 0) kill(child_, SIGINT);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return code_;
  }

  // Sends these bytes and gives all that comes back until the other side closes or says nothing for a while.
  std::string exchange(const std::string& bytes, bool no_more = false) const {
    const int connection = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(std::uint16_t(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string answer;
    const timeval patience{5, 0};
    setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (connect(connection, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) {
      (void)!send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (no_more) shutdown(connection, SHUT_WR);  // so that nobody waits for the rest of it
      std::array<char, 4096> piece;
      for (ssize_t got; (got = recv(connection, piece.data(), piece.size(), 0)) > 0;)
        answer.append(piece.data(), std::size_t(got));
    }
    close(connection);
    return answer;
  }
  std::string request(const std::string& line, const std::string& more = {}) const {
    return exchange(line + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                    "\r\nConnection: close\r\n" + more + "\r\n");
  }
  std::string get(const std::string& path) const { return request("GET " + path); }

  std::string address;
  int port = 0;

 private:
  pid_t child_ = 0;
  int code_ = -1;
};

int status_of(const std::string& answer) {
  return answer.rfind("HTTP/1.1 ", 0) == 0 ? std::atoi(answer.c_str() + 9) : 0;
}
std::string body_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  return end == std::string::npos ? "" : answer.substr(end + 4);
}
bool has_header(const std::string& answer, const std::string& header) {
  return answer.find("\r\n" + header + "\r\n") < answer.find("\r\n\r\n") + 2;
}

class View : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_view_" + std::to_string(getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    write("s.gyre.json", kScene);
    if (run_program({"view", "--viewer", "none"}, folder_).err.find("built without") != std::string::npos) {
      GTEST_SKIP() << "this gyre was built without gyre view";
    }
    write("parts/tile.obj", kTile);
    write("secret.txt", "secret");
    write("site/index.html", "<p>the viewer</p>");
    write("site/assets/main.js", "js");
    write("site/assets/engine.wasm", "wasm");
    write("site/scenes/index.json", "{\"scenes\": []}");
    fs::create_symlink(folder_ / "secret.txt", folder_ / "site/out.txt");
    fs::create_directory_symlink(folder_ / "parts", folder_ / "site/parts");
    fs::create_symlink(folder_ / "site/assets/main.js", folder_ / "site/inside.js");
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::vector<std::string> arguments(std::vector<std::string> more) const {
    more.insert(more.end(), {"--port", "0", "--no-open", "--viewer", "site"});
    return more;
  }

  fs::path folder_;
};

TEST_F(View, ServesTheViewerTheSceneAndItsMeshes) {
  RunningView view(arguments({"s.gyre.json"}), folder_);
  EXPECT_EQ(view.address, "http://127.0.0.1:" + std::to_string(view.port) + "/?file=/files/s.gyre.json");
  EXPECT_EQ(body_of(view.get("/?file=/files/s.gyre.json")), "<p>the viewer</p>");
  EXPECT_EQ(body_of(view.get("/index.html")), "<p>the viewer</p>");
  EXPECT_EQ(body_of(view.get("/files/s.gyre.json")), kScene);
  EXPECT_EQ(body_of(view.get("/files/parts/tile.obj")), kTile);
  EXPECT_EQ(body_of(view.get("/scenes/index.json")), "{\"scenes\": []}");
  EXPECT_EQ(body_of(view.get("/assets/main.js")), "js");
  EXPECT_EQ(body_of(view.get("/inside.js")), "js");
  write("s.gyre.json", "{}");  // the file as it is, not as it was
  EXPECT_EQ(body_of(view.get("/files/s.gyre.json")), "{}");
  EXPECT_EQ(view.finish(), 0);
}

TEST_F(View, ShowsStandardInput) {
  const std::string plain = R"({"gyre_scene": 1, "name": "plain", "bodies": [{"name": "box", "shapes": [{"type": "sphere", "radius": 1}]}]})";
  write("plain.gyre.json", plain);
  RunningView view(arguments({"-"}), folder_, "plain.gyre.json");
  EXPECT_EQ(view.address, "http://127.0.0.1:" + std::to_string(view.port) + "/?file=/files/input.gyre.json");
  EXPECT_EQ(body_of(view.get("/files/input.gyre.json")), plain);
  EXPECT_EQ(view.finish(), 0);
}

TEST_F(View, SaysWhatBrowsersMustKnow) {
  RunningView view(arguments({"s.gyre.json"}), folder_);
  for (const char* path : {"/", "/assets/main.js", "/files/s.gyre.json", "/none"}) {
    const std::string answer = view.get(path);
    EXPECT_TRUE(has_header(answer, "Cross-Origin-Opener-Policy: same-origin")) << answer;
    EXPECT_TRUE(has_header(answer, "Cross-Origin-Embedder-Policy: require-corp")) << answer;
    EXPECT_TRUE(has_header(answer, "X-Content-Type-Options: nosniff")) << answer;
    EXPECT_EQ(answer.find("Access-Control-Allow-Origin"), std::string::npos);
  }
  EXPECT_TRUE(has_header(view.get("/"), "Content-Type: text/html; charset=utf-8"));
  EXPECT_TRUE(has_header(view.get("/assets/main.js"), "Content-Type: text/javascript; charset=utf-8"));
  EXPECT_TRUE(has_header(view.get("/assets/engine.wasm"), "Content-Type: application/wasm"));
  EXPECT_TRUE(has_header(view.get("/scenes/index.json"), "Content-Type: application/json"));
  EXPECT_TRUE(has_header(view.request("HEAD /files/s.gyre.json"),
                         "Content-Length: " + std::to_string(kScene.size())));
  EXPECT_EQ(body_of(view.request("HEAD /files/s.gyre.json")), "");
  const std::string part = view.request("GET /files/s.gyre.json", "Range: bytes=1-11\r\n");
  EXPECT_EQ(status_of(part), 206);
  EXPECT_EQ(body_of(part), kScene.substr(1, 11));
}

TEST_F(View, GivesNothingElse) {
  RunningView view(arguments({"s.gyre.json"}), folder_);
  const char* const paths[] = {"/secret.txt",
                               "/files/secret.txt",
                               "/files/",
                               "/files",
                               "/files/site/index.html",
                               "/assets",
                               "/assets/",
                               "/out.txt",
                               "/parts/tile.obj",
                               "/../secret.txt",
                               "/files/../secret.txt",
                               "/assets/../../secret.txt",
                               "/assets/../index.html",
                               "/%2e%2e/secret.txt",
                               "/files/%2e%2e%2fsecret.txt",
                               "/files/..%2Fsecret.txt",
                               "/files/%252e%252e/secret.txt",
                               "/..%5csecret.txt",
                               "/files/..\\secret.txt",
                               "/files/s.gyre.json%00.txt",
                               "/files/s.gyre.json/",
                               "//index.html",
                               "/./index.html",
                               "/etc/passwd",
                               "//etc/passwd",
                               "/%2Fetc%2Fpasswd",
                               "/files//etc/passwd",
                               "/files/%c0%ae%c0%ae/secret.txt",
                               "/files/%u002e%u002e/secret.txt",
                               "/FILES/S.GYRE.JSON",
                               "/index.html%20",
                               "/%",
                               "/%zz",
                               "file:///etc/passwd",
                               "http://127.0.0.1/secret.txt",
                               "*"};
  for (const char* path : paths) {
    const std::string answer = view.get(path);
    EXPECT_TRUE(status_of(answer) == 404 || status_of(answer) == 400) << path << "\n" << answer;
    EXPECT_EQ(answer.find("secret\n"), std::string::npos) << path;
    EXPECT_EQ(body_of(answer).find("root:"), std::string::npos) << path;
    EXPECT_NE(body_of(answer), "secret") << path;
  }
}

TEST_F(View, AnswersOnlyReadersWhoMeanThisServer) {
  RunningView view(arguments({"s.gyre.json"}), folder_);
  const std::string port = std::to_string(view.port);
  const auto as_host = [&](const std::string& hosts) {
    return status_of(view.exchange("GET / HTTP/1.1\r\n" + hosts + "Connection: close\r\n\r\n"));
  };
  EXPECT_EQ(as_host("Host: localhost:" + port + "\r\n"), 200);
  EXPECT_EQ(as_host("Host: 127.0.0.1:" + port + "\r\n"), 200);
  for (const std::string& hosts :
       {std::string(), std::string("Host: evil.example\r\n"), "Host: evil.example:" + port + "\r\n",
        "Host: 127.0.0.1.evil.example:" + port + "\r\n", std::string("Host: 127.0.0.1:1\r\n"),
        std::string("Host:\r\n"), "Host: 127.0.0.1:" + port + "\r\nHost: evil.example\r\n"}) {
    EXPECT_EQ(as_host(hosts), 403) << hosts;
  }
  for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS"}) {
    EXPECT_EQ(status_of(view.request(std::string(method) + " /files/s.gyre.json", "Content-Length: 0\r\n")),
              405)
        << method;
  }
  EXPECT_EQ(file_text(folder_ / "s.gyre.json"), kScene);
}

TEST_F(View, LivesThroughNonsense) {
  RunningView view(arguments({"s.gyre.json"}), folder_);
  (void)view.exchange("\r\n\r\n", true);
  (void)view.exchange("GET\r\n\r\n", true);
  (void)view.exchange(std::string(100'000, 'A') + "\r\n\r\n", true);
  (void)view.exchange("GET /" + std::string(20'000, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n", true);
  (void)view.exchange("GET / HTTP/1.1\r\n" + std::string(20'000, 'h') + ": x\r\n\r\n", true);
  (void)view.request("GET /files/s.gyre.json", "Range: bytes=99999999999999999999-\r\n");
  (void)view.request("GET /files/s.gyre.json", "Range: bytes=5-1\r\n");
  (void)view.request("GET /files/s.gyre.json", "Range: bytes=-99999999\r\n");
  (void)view.request("GET /files/s.gyre.json", "Range: bytes=0-0,0-0,0-0,0-0\r\n");
  (void)view.exchange("POST / HTTP/1.1\r\nContent-Length: 18446744073709551615\r\n\r\n", true);
  (void)view.exchange(std::string("GET / HTTP/1.1\r\n\0\0\0", 19), true);
  EXPECT_EQ(status_of(view.get("/files/s.gyre.json")), 200);
  EXPECT_EQ(view.finish(), 0);
}

TEST_F(View, ServesRecordingsAndSaysWhatIsWrongWithThem) {
  ASSERT_EQ(
      run_program({"simulate", "s.gyre.json", "--steps", "30", "--record", "a run.gyrec", "--quiet"}, folder_)
          .code,
      0);
  const std::string recording = file_text(folder_ / "a run.gyrec");
  {
    RunningView view(arguments({"a run.gyrec"}), folder_);
    EXPECT_EQ(view.address, "http://127.0.0.1:" + std::to_string(view.port) + "/?file=/files/a%20run.gyrec");
    EXPECT_EQ(body_of(view.get("/files/a%20run.gyrec")), recording);
  }
  // Behind the last frame stand the hash of the whole state, 40 bytes, and the end, 32.
  write("cut.gyrec", recording.substr(0, recording.size() - 130));
  {
    RunningView view(arguments({"cut.gyrec"}), folder_);
    EXPECT_NE(view.port, 0);
    view.finish();
    EXPECT_NE(file_text(folder_ / "view.err").find("first 30 frames are whole"), std::string::npos)
        << file_text(folder_ / "view.err");
  }
  write("empty.gyrec", recording.substr(0, 40));
  const Finished refused = run_program({"view", "empty.gyrec", "--no-open"}, folder_);
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(refused.out, "");
  EXPECT_NE(refused.err.find("empty.gyrec: recording: "), std::string::npos) << refused.err;
}

// What a page without the engine asks for: a JSON text behind its length, and arrays behind that.
struct Poses {
  explicit Poses(const std::string& answer) {
    const std::string body = body_of(answer);
    std::uint32_t length = 0;
    if (status_of(answer) != 200 || body.size() < sizeof length) return;
    std::memcpy(&length, body.data(), sizeof length);
    if (body.size() < sizeof length + length) return;
    text = nlohmann::json::parse(body.substr(sizeof length, length), nullptr, false);
    bytes = body.substr(sizeof length + length);
  }
  template <typename T>
  std::vector<T> array(const nlohmann::json& place) const {
    std::vector<T> out(place.at(1).get<std::size_t>());
    const std::size_t begin = place.at(0);
    if (begin + out.size() * sizeof(T) > bytes.size()) return {};
    std::memcpy(out.data(), bytes.data() + begin, out.size() * sizeof(T));
    return out;
  }
  nlohmann::json text;
  std::string bytes;
};

TEST_F(View, DecodesARecordingForAPageWithoutTheEngine) {
  const std::vector<std::string> record = {"simulate", "s.gyre.json", "--steps",
                                           "150",      "--quiet",     "--record"};
  const auto recorded = [&](const std::string& name, const std::string& as) {
    std::vector<std::string> arguments = record;
    arguments.insert(arguments.end(), {name, "--record-as", as});
    ASSERT_EQ(run_program(arguments, folder_).code, 0);
  };
  recorded("run.gyrec", "all");
  recorded("commands.gyrec", "commands");
  const std::string stored = file_text(folder_ / "run.gyrec");
  const auto* const begin = reinterpret_cast<const std::byte*>(stored.data());
  Result<PoseTrack> track = PoseTrack::open({begin, begin + stored.size()});
  ASSERT_TRUE(track);
  for (const char* file : {"run.gyrec", "commands.gyrec"}) {
    RunningView view(arguments({file}), folder_);
    const std::string path = std::string("/files/") + file;
    const std::string answer = view.get(path + "?scene");
    EXPECT_TRUE(has_header(answer, "Content-Type: application/vnd.gyre.poses")) << answer.substr(0, 400);
    const Poses scene(answer);
    ASSERT_EQ(scene.text.value("frames", 0), 151);
    ASSERT_EQ(scene.text["models"].size(), 2u);
    EXPECT_EQ(scene.text["models"][0]["type"], "fixed");
    EXPECT_EQ(scene.text["models"][1]["shapes"][0]["geometry"]["halfExtents"],
              nlohmann::json({0.5, 0.5, 0.5}));
    ASSERT_EQ(scene.text["surfaces"].size(), 1u);
    const nlohmann::json& tile = scene.text["surfaces"][0];
    EXPECT_EQ(tile["key"], scene.text["models"][0]["shapes"][0]["geometry"]["surface"]);
    EXPECT_EQ(scene.array<float>(tile["vertices"]).size(), 12u);
    EXPECT_EQ(scene.array<std::uint32_t>(tile["indices"]).size(), 6u);

    // Group by group, all that the track holds.
    const int group = scene.text["group"];
    ASSERT_GT(group, 0);
    for (int first = 0; first < 151; first += group) {
      const Poses poses(view.get(path + "?frames=" + std::to_string(first / group)));
      ASSERT_EQ(poses.text["frames"].size(), std::size_t(std::min(group, 151 - first)));
      for (std::size_t i = 0; i < poses.text["frames"].size(); ++i) {
        const nlohmann::json& frame = poses.text["frames"][i];
        ASSERT_EQ(track->seek(std::size_t(first) + i).code, ErrorCode::none);
        const TrackFrame expected = track->frame();
        EXPECT_EQ(frame["step"], expected.step);
        EXPECT_EQ(frame["time"], expected.time);
        const std::vector<float> numbers = poses.array<float>(frame["poses"]);
        const std::vector<std::uint8_t> awake = poses.array<std::uint8_t>(frame["awake"]);
        ASSERT_EQ(numbers.size(), 14u);
        ASSERT_EQ(awake.size(), 2u);
        const Pose& box = expected.poses[1];
        EXPECT_EQ(numbers[8], float(box.position.y));
        EXPECT_EQ(numbers[13], box.orientation.w);
        EXPECT_EQ(awake[1], expected.awake[1]);
        const nlohmann::json& set = poses.text["sets"][std::to_string(frame["set"].get<int>())];
        EXPECT_EQ(set["ids"].size(), 2u);
        // Commands alone hold no names.
        EXPECT_EQ(set["names"], std::strcmp(file, "run.gyrec") == 0 ? nlohmann::json({"ground", "box"})
                                                                    : nlohmann::json({"", ""}));
        EXPECT_EQ(set["models"], nlohmann::json({0, 1}));
      }
    }
    for (const char* wrong :
         {"?frames=99", "?frames=-1", "?frames=", "?frames=0x0", "?frames=99999999999999999999"})
      EXPECT_EQ(status_of(view.get(path + wrong)), 404) << wrong;
    EXPECT_EQ(body_of(view.get(path)),
              file_text(folder_ / file));  // and the file itself, for a page with the engine
  }
  // Damaged while it is served: words, and no crash.
  RunningView view(arguments({"run.gyrec"}), folder_);
  write("run.gyrec", stored.substr(0, 40));
  const std::string broken = view.get("/files/run.gyrec?scene");
  EXPECT_EQ(status_of(broken), 500);
  EXPECT_NE(body_of(broken).find("recording: "), std::string::npos) << broken;
  EXPECT_EQ(view.finish(), 0);
}

TEST_F(View, SaysThatAViewerWithoutTheEngineRunsNoScenes) {
  ASSERT_EQ(
      run_program({"simulate", "s.gyre.json", "--steps", "3", "--record", "r.gyrec", "--quiet"}, folder_)
          .code,
      0);
  write("site/without_engine.txt", "");
  const auto words = [&](const char* file) {
    RunningView view(arguments({file}), folder_);
    view.finish();
    return file_text(folder_ / "view.err");
  };
  EXPECT_NE(words("s.gyre.json").find("./run --live"), std::string::npos);
  EXPECT_EQ(words("r.gyrec").find("./run --live"), std::string::npos);
}

TEST_F(View, RefusesWhatCannotBeShown) {
  write("bad.gyre.json",
        R"({"gyre_scene": 1, "bodies": [{"name": "b", "shapes": [{"type": "sphere", "radius": -1}]}]})");
  for (const auto& [file, word] : {std::pair<const char*, const char*>{"bad.gyre.json", "found -1"},
                                   {"none.gyre.json", "no such file"},
                                   {".", "is a folder"}}) {
    const Finished done = run_program({"view", file, "--no-open", "--viewer", "site"}, folder_);
    EXPECT_EQ(done.code, 3);
    EXPECT_NE(done.err.find(word), std::string::npos) << done.err;
    EXPECT_EQ(done.out, "");
  }
  EXPECT_EQ(run_program({"view", "--viewer", "parts", "--no-open"}, folder_).code, 3);
  EXPECT_EQ(run_program({"view", "--port", "70000"}, folder_).code, 2);
  EXPECT_EQ(run_program({"view", "--port", "http"}, folder_).code, 2);
}

TEST_F(View, APortThatIsTakenIsAnErrorOnlyIfItWasAskedFor) {
  RunningView first(arguments({}), folder_);
  EXPECT_EQ(first.address, "http://127.0.0.1:" + std::to_string(first.port) + "/");
  const Finished second =
      run_program({"view", "--port", std::to_string(first.port), "--no-open", "--viewer", "site"}, folder_);
  EXPECT_EQ(second.code, 3);
  EXPECT_NE(second.err.find("port " + std::to_string(first.port)), std::string::npos) << second.err;
  RunningView third({"--no-open", "--viewer", "site"}, folder_);
  RunningView fourth({"--no-open", "--viewer", "site"}, folder_);
  EXPECT_NE(third.port, 0);
  EXPECT_NE(fourth.port, 0);
  EXPECT_NE(third.port, fourth.port);
}

TEST_F(View, WithoutAViewerThePageSaysHowToBuildIt) {
  // A copy of the program knows of no viewer around it.
  fs::create_directories(folder_ / "bin");
  fs::copy_file(program_path(), folder_ / "bin/gyre");
  const std::string shell = "cd '" + folder_.string() +
                            "' && (env -u GYRE_VIEWER -u DISPLAY ./bin/gyre view s.gyre.json --port 0 > "
                            "out.txt 2> err.txt & echo $! > pid.txt)";
  ASSERT_EQ(std::system(shell.c_str()), 0);
  std::string address;
  for (int i = 0; i < 500 && address.find('\n') == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    address = file_text(folder_ / "out.txt");
  }
  RunningView client({"--help"}, folder_);  // for its way to ask
  const std::size_t colon = address.rfind(':');
  ASSERT_NE(colon, std::string::npos);
  client.port = std::atoi(address.c_str() + colon + 1);
  const std::string page = client.get("/");
  const std::string scene = client.get("/files/s.gyre.json");
  client.port = 0;
  kill(std::atoi(file_text(folder_ / "pid.txt").c_str()), SIGINT);
  EXPECT_EQ(status_of(page), 200);
  EXPECT_NE(page.find("tools/build_viewer.sh"), std::string::npos) << page;
  EXPECT_NE(page.find("/files/s.gyre.json"), std::string::npos);
  EXPECT_EQ(body_of(scene), kScene);
  EXPECT_NE(file_text(folder_ / "err.txt").find("tools/build_viewer.sh"), std::string::npos);
}

}  // namespace
}  // namespace gyre::view_test
