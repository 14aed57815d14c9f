#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

namespace patina::testing {

/// What a process printed, and how it ended.
struct Outcome {
    int exit_code = -1;  ///< -1 when a signal ended it
    int signal = 0;      ///< that ended it; 0 when it ended by itself
    std::string out, err;
};

/// The program under test as a child process. Its output goes to files in a folder of its own, removed with it; a
/// process that was not waited for is killed.
class Program {
  public:
    using Environment = std::vector<std::pair<std::string, std::string>>;

    /// Starts `patina` with these arguments and changes to the environment.
    explicit Program(const std::vector<std::string>& arguments, const Environment& changes = {});
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    bool running();
    /// Waits until the program handles a signal by itself, or ends.
    void await_handler(int signal);
    void send(int signal);
    Outcome wait();

  private:
    void reap(int options);

    std::filesystem::path output_;
    pid_t pid_ = -1;
    bool ended_ = false;
    int status_ = 0;
};

/// Runs a line of the shell in which $PATINA is the program; returns the exit code, -1 where a signal ended the shell.
int shell(const std::string& line);

/// Runs `patina` to its end.
Outcome patina(const std::vector<std::string>& arguments, const Program::Environment& changes = {});

}  // namespace patina::testing
