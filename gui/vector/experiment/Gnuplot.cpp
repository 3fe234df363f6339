#include "gui/vector/experiment/Gnuplot.h"

#include "gui/vector/Failure.h"

#include <cstdio>
#include <memory>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace hermes::vector {

namespace {

constexpr int notFound = 127;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE *)>;

File temporaryFile() {
    File file(std::tmpfile(), std::fclose);
    if (!file)
        throw Failure("gnuplot: a temporary file cannot be made");
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

std::optional<std::string> runGnuplot(const std::string &script) {
    const File in = temporaryFile(), out = temporaryFile(), err = temporaryFile();
    std::fwrite(script.data(), 1, script.size(), in.get());
    std::rewind(in.get());
    std::fflush(in.get());

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(in.get()), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(err.get()), STDERR_FILENO);
    char name[] = "gnuplot", dash[] = "-";
    char *arguments[] = {name, dash, nullptr};
    pid_t child = 0;
    const int spawned = posix_spawnp(&child, name, &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (spawned != 0)
        return std::nullopt;
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == notFound)
        return std::nullopt;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw Failure("gnuplot: " + contents(err.get()));
    return contents(out.get());
}

} // namespace hermes::vector
