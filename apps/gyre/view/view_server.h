// A web server for this machine's own browser: it listens on 127.0.0.1 alone, gives the files of a table and nothing else, and
// answers only requests that were meant for it.
#pragma once

#include "view/served_files.h"

#include <memory>
#include <string>

namespace gyre {

class ViewServer {
 public:
  // `front_page` is shown under "/" when the table has no such page.
  ViewServer(ServedFiles files, std::string front_page);
  ~ViewServer();

  // 0: any free port. The port, or -1 if it cannot be had.
  int bind(int port);
  // Serves until stop() or an error; returns at once.
  void start();
  void stop();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace gyre
