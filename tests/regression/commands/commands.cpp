// The program for many commands in one process, started by many_commands.py.
//
//   commands FOLDER
//
// Rank R reads commands from the pipe FOLDER/in.R, one per line: working directory and words, each followed by a tab.
// The output of a command is in FOLDER/out.R and FOLDER/err.R; its exit status is written to the pipe FOLDER/status.R.
#define main sprekk_main
#include "sprekk/main.cpp"
#undef main

#include <filesystem>
#include <fstream>
#include <sstream>

#include <fcntl.h>

namespace {

/// Redirects standard output (1) or error (2) to a new file.
void redirect(int stream, const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::dup2(file, stream);
  ::close(file);
}

}  // namespace

int main(int argc, char** argv) {
  base::keep_heap();
  std::signal(SIGXFSZ, SIG_IGN);
  int n_libraries_may_read = 1;
  Tpetra::ScopeGuard guard(&n_libraries_may_read, &argv);
  if (argc != 2) return 2;
  const auto comm = Tpetra::getDefaultComm();
  const auto file = [&](const std::string& name) {
    return std::string(argv[1]) + '/' + name + '.' + std::to_string(comm->getRank());
  };
  std::ifstream in(file("in"));
  std::ofstream status(file("status"));
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> words;
    std::istringstream all(line);
    for (std::string word; std::getline(all, word, '\t');) words.push_back(word);
    std::filesystem::current_path(words.at(0));
    words.at(0) = "sprekk";
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    redirect(STDOUT_FILENO, file("out"));
    redirect(STDERR_FILENO, file("err"));
    const int result = run_command(static_cast<int>(words.size()), pointers.data(), comm);
    handle_stop_signals(SIG_DFL);
    std::cout.flush();
    std::fflush(nullptr);
    status << result << std::endl;
  }
  return 0;
}
