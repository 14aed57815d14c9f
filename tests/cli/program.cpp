#include "tests/cli/program.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/core/error.h"
#include "tests/sensor/sequences.h"

namespace patina::testing {

namespace fs = std::filesystem;

namespace {

/// In the child: output to files, then the program; ends the child with 127 where that fails.
[[noreturn]] void become_patina(const std::vector<std::string>& arguments, const Program::Environment& changes,
                                const fs::path& output) {
    for (const auto& [name, value] : changes) setenv(name.c_str(), value.c_str(), 1);
    const int out = open((output / "out").c_str(), O_WRONLY | O_CREAT, 0600);
    const int err = open((output / "err").c_str(), O_WRONLY | O_CREAT, 0600);
    if (out < 0 || err < 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(err, STDERR_FILENO) < 0) _exit(127);
    std::vector<char*> argv{const_cast<char*>(PATINA_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(PATINA_PROGRAM, argv.data());
    _exit(127);
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, const Environment& changes) {
    std::string name = (fs::temp_directory_path() / "patina-program-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error(name, " cannot be created");
    output_ = name;
    pid_ = fork();
    if (pid_ < 0) throw Error("no process can be started: errno is ", errno);
    if (pid_ == 0) become_patina(arguments, changes, output_);
}

Program::~Program() {
    if (running()) {
        send(SIGKILL);
        reap(0);
    }
    std::error_code ignored;
    fs::remove_all(output_, ignored);
}

void Program::reap(int options) {
    if (!ended_) ended_ = waitpid(pid_, &status_, options) == pid_;
}

bool Program::running() {
    reap(WNOHANG);
    return !ended_;
}

void Program::await_handler(int signal) {
    const auto handled = [&] {
        std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
        for (std::string word; status >> word;) {
            if (word != "SigCgt:") continue;
            uint64_t mask = 0;
            status >> std::hex >> mask;
            return (mask >> (signal - 1) & 1) != 0;
        }
        return false;
    };
    while (running() && !handled()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

void Program::send(int signal) { kill(pid_, signal); }

Outcome Program::wait() {
    reap(0);
    Outcome outcome;
    if (WIFEXITED(status_)) outcome.exit_code = WEXITSTATUS(status_);
    if (WIFSIGNALED(status_)) outcome.signal = WTERMSIG(status_);
    outcome.out = sensor::testing::read_text(output_ / "out");
    outcome.err = sensor::testing::read_text(output_ / "err");
    return outcome;
}

int shell(const std::string& line) {
    setenv("PATINA", PATINA_PROGRAM, 1);
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Outcome patina(const std::vector<std::string>& arguments, const Program::Environment& changes) {
    return Program(arguments, changes).wait();
}

}  // namespace patina::testing
