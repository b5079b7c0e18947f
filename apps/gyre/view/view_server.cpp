// The web server. See view_server.h.
#include "view/view_server.h"

#include <httplib.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

namespace gyre {

namespace {

constexpr const char* kHost = "127.0.0.1";

// Beside what makes a page cross-origin isolated, so that the engine may use threads in it: nothing from elsewhere is run,
// no other page may hold this one, and no browser guesses what a file is.
const httplib::Headers kHeaders = {
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Embedder-Policy", "require-corp"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-cache"},
    {"Content-Security-Policy",
     "default-src 'self'; script-src 'self' 'wasm-unsafe-eval' blob:; worker-src 'self' "
     "blob:; "
     "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; connect-src "
     "'self' data: blob:; "
     "object-src 'none'; base-uri 'self'; frame-ancestors 'none'"},
};

void give_text(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text, "text/plain; charset=utf-8");
}

// With ?scene or ?frames=N (served_recording.h).
void give_poses(httplib::Response& response, const httplib::Request& request, ServedRecording& recording) {
  const std::string group = request.get_param_value("frames");
  const bool numbers =
      !group.empty() && group.size() < 10 && group.find_first_not_of("0123456789") == std::string::npos;
  if (request.has_param("frames") && !numbers) return give_text(response, 404, "There are no such frames.\n");
  const Result<std::string> answer =
      numbers ? recording.frames(std::size_t(std::atoll(group.c_str()))) : recording.scene();
  if (!answer) {
    const bool unknown = answer.error().code == ErrorCode::invalid_argument;
    return give_text(response, unknown ? 404 : 500, std::string(answer.error().message) + "\n");
  }
  response.status = 200;
  response.set_content(*answer, "application/vnd.gyre.poses");
}

// Piece by piece, so that a large recording needs no memory. The length is that of the moment. The status is left to the library,
// which knows whether a part was asked for.
void give_file(httplib::Response& response, const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const std::shared_ptr<std::FILE> file(error ? nullptr : std::fopen(path.c_str(), "rb"),
                                        [](std::FILE* opened) {
                                          if (opened != nullptr) std::fclose(opened);
                                        });
  if (file == nullptr) {
    give_text(response, 404, "This file can no longer be read.\n");
    return;
  }
  if (size == 0) {
    response.set_content("", media_type(path));
    return;
  }
  response.set_content_provider(std::size_t(size), media_type(path),
                                [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  constexpr std::size_t kPiece = std::size_t(1) << 16;
                                  char piece[kPiece];
                                  if (std::fseek(file.get(), long(offset), SEEK_SET) != 0) return false;
                                  const std::size_t read =
                                      std::fread(piece, 1, length < kPiece ? length : kPiece, file.get());
                                  return read > 0 && sink.write(piece, read);
                                });
}

}  // namespace

struct ViewServer::Inside {
  ServedFiles files;
  std::string front_page;
  int port = -1;
  httplib::Server server;
  std::thread thread;

  // A page of another site can send requests here, also under a name that it made lead here. It cannot choose the host that
  // the browser names.
  bool meant_for_us(const httplib::Request& request) const {
    const std::string host = request.get_header_value("Host"), end = ":" + std::to_string(port);
    return request.get_header_value_count("Host") == 1 &&
           (host == kHost + end || host == "localhost" + end ||
            (port == 80 && (host == kHost || host == "localhost")));
  }

  void answer(const httplib::Request& request, httplib::Response& response) const {
    if (!meant_for_us(request))
      return give_text(response, 403, "This server answers only for 127.0.0.1 and localhost.\n");
    if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      return give_text(response, 405, "Only reading is possible here.\n");
    }
    if (request.has_param("scene") || request.has_param("frames")) {
      if (ServedRecording* const recording = files.find_recording(request.path)) {
        return give_poses(response, request, *recording);
      }
    }
    if (const std::string* const file = files.find(request.path == "/" ? "/index.html" : request.path)) {
      return give_file(response, *file);
    }
    if (request.path == "/") {
      response.status = 200;
      response.set_content(front_page, "text/html; charset=utf-8");
      return;
    }
    give_text(response, 404, "There is no such file here.\n");
  }
};

ViewServer::ViewServer(ServedFiles files, std::string front_page) : inside_(std::make_unique<Inside>()) {
  Inside* const inside = inside_.get();
  inside->files = std::move(files);
  inside->front_page = std::move(front_page);
  httplib::Server& server = inside->server;
  server.set_default_headers(kHeaders);
  server.set_payload_max_length(0);
  server.set_tcp_nodelay(true);
  // The library would let two programs share a port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, reinterpret_cast<const char*>(&yes), sizeof yes);
  });
  // Before the library looks for anything itself: it is given nothing to find.
  server.set_pre_routing_handler([inside](const httplib::Request& request, httplib::Response& response) {
    inside->answer(request, response);
    return httplib::Server::HandlerResponse::Handled;
  });
}

ViewServer::~ViewServer() { stop(); }

int ViewServer::bind(int port) {
  httplib::Server& server = inside_->server;
  inside_->port = port == 0 ? server.bind_to_any_port(kHost) : server.bind_to_port(kHost, port) ? port : -1;
  return inside_->port;
}

void ViewServer::start() {
  inside_->thread = std::thread([this] { inside_->server.listen_after_bind(); });
}

void ViewServer::stop() {
  if (!inside_->thread.joinable()) return;
  // A server that has not come to listening yet would not see that it is told to stop.
  for (int i = 0; i < 200 && !inside_->server.is_running(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  inside_->server.stop();
  inside_->thread.join();
}

}  // namespace gyre
