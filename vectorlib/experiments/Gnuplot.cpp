#include "vectorlib/experiments/Gnuplot.h"

#include "common/platform/Program.h"
#include "gui/vector/Failure.h"

namespace hermes::experiments {

using vector::Failure;

std::optional<std::string> runGnuplot(const std::string &script) {
    try {
        std::optional<ProgramEnd> end = runProgram("gnuplot", "-", script);
        if (!end)
            return std::nullopt;
        if (end->failed)
            throw Failure(end->err);
        return std::move(end->out);
    } catch (const std::runtime_error &error) {
        throw Failure(std::string("gnuplot: ") + error.what());
    }
}

} // namespace hermes::experiments
