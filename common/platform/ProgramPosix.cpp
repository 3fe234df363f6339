#include "common/platform/Program.h"

#include <cstdio>
#include <memory>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace hermes {

namespace {

constexpr int notFound = 127;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE *)>;

File temporaryFile() {
    File file(std::tmpfile(), std::fclose);
    if (!file)
        throw std::runtime_error("a temporary file cannot be made");
    return file;
}

std::string contents(std::FILE *file) {
    std::string text;
    std::rewind(file);
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, file))
        text.append(buffer, n);
    return text;
}

} // namespace

std::vector<std::string> programArguments(int argc, char **argv) {
    return std::vector<std::string>(argv + (argc > 0), argv + argc);
}

std::filesystem::path programFile() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path() : program;
}

std::optional<ProgramEnd> runProgram(const std::string &name, const std::string &argument,
                                     const std::string &input) {
    const File in = temporaryFile(), out = temporaryFile(), err = temporaryFile();
    std::fwrite(input.data(), 1, input.size(), in.get());
    std::rewind(in.get());
    std::fflush(in.get());

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(in.get()), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(err.get()), STDERR_FILENO);
    std::string first = name, second = argument;
    char *arguments[] = {first.data(), second.data(), nullptr};
    pid_t child = 0;
    const int spawned = ::posix_spawnp(&child, name.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (spawned != 0)
        return std::nullopt;
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == notFound)
        return std::nullopt;
    return ProgramEnd{!WIFEXITED(status) || WEXITSTATUS(status) != 0, contents(out.get()),
                      contents(err.get())};
}

void becomeProgram(const std::string &name, const std::vector<std::string> &arguments) {
    std::vector<std::string> words{name};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char *> pointers;
    for (std::string &word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execvp(name.c_str(), pointers.data());
}

} // namespace hermes
