// Which files are served, and under which paths: a table that is made before the first request. A request is looked up in it as
// it is, so no path that a request could think of leads anywhere else.
#pragma once

#include "view/served_recording.h"

#include <map>
#include <memory>
#include <string>

namespace gyre {

class ServedFiles {
 public:
  // All files below the folder, under `prefix` and their path in it. Links that lead out of the folder are left out.
  void add_folder(const std::string& prefix, const std::string& folder);
  // One file.
  void add_file(const std::string& path, const std::string& file);

  // One recording, which can also be asked for its poses.
  void add_recording(const std::string& path, const std::string& file);

  // Where the file lies; null if the path is not one of those.
  const std::string* find(const std::string& path) const;
  // Null if the path is not one of a recording.
  ServedRecording* find_recording(const std::string& path) const;

 private:
  std::map<std::string, std::string> files_;
  std::map<std::string, std::unique_ptr<ServedRecording>> recordings_;
};

// By the name's end; application/octet-stream if it says nothing.
std::string media_type(const std::string& path);

// A name as a part of a URL's path.
std::string percent_encoded(const std::string& name);

}  // namespace gyre
