// The table of served files. See served_files.h.
#include "view/served_files.h"

#include <filesystem>
#include <system_error>
#include <utility>

namespace gyre {

namespace fs = std::filesystem;

void ServedFiles::add_folder(const std::string& prefix, const std::string& folder) {
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return;
  // Links to folders are not followed.
  for (fs::recursive_directory_iterator entry(root, fs::directory_options::skip_permission_denied, error),
       end;
       !error && entry != end; entry.increment(error)) {
    std::error_code broken;
    const fs::path file = fs::canonical(entry->path(), broken);
    if (broken || !fs::is_regular_file(file, broken)) continue;
    const fs::path inside = file.lexically_relative(root);
    if (inside.empty() || *inside.begin() == "..") continue;
    files_[prefix + entry->path().lexically_relative(root).generic_string()] = file.string();
  }
}

void ServedFiles::add_file(const std::string& path, const std::string& file) { files_[path] = file; }

void ServedFiles::add_recording(const std::string& path, const std::string& file) {
  add_file(path, file);
  recordings_[path] = std::make_unique<ServedRecording>(file);
}

ServedRecording* ServedFiles::find_recording(const std::string& path) const {
  const auto found = recordings_.find(path);
  return found == recordings_.end() ? nullptr : found->second.get();
}

const std::string* ServedFiles::find(const std::string& path) const {
  const auto found = files_.find(path);
  return found == files_.end() ? nullptr : &found->second;
}

std::string media_type(const std::string& path) {
  constexpr std::pair<const char*, const char*> kTypes[] = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".wasm", "application/wasm"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".webp", "image/webp"},
      {".jpg", "image/jpeg"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".obj", "text/plain; charset=utf-8"},
      {".txt", "text/plain; charset=utf-8"},
      {".md", "text/plain; charset=utf-8"},
  };
  const std::string end = fs::path(path).extension().string();
  for (const auto& [extension, type] : kTypes) {
    if (end == extension) return type;
  }
  return "application/octet-stream";
}

std::string percent_encoded(const std::string& name) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_' || c == '~' || c == '/';
    if (plain) {
      out += c;
    } else {
      out += '%';
      out += kDigits[byte >> 4];
      out += kDigits[byte & 15];
    }
  }
  return out;
}

}  // namespace gyre
