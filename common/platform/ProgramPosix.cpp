#include "common/platform/Program.h"

#include <unistd.h>

namespace hermes {

std::vector<std::string> programArguments(int argc, char **argv) {
    return std::vector<std::string>(argv + (argc > 0), argv + argc);
}

std::filesystem::path programFile() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path() : program;
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
