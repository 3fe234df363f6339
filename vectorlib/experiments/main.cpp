#include "gui/vector/CommandLine.h"
#include "vectorlib/experiments/Commands.h"

using namespace hermes;

/// hermes-experiments: what the documents behind Hermes publish, made anew. See docs/experiments.md.
int main(int argc, char **argv) {
    const vector::CommandLine line{"hermes-experiments",
                                   HERMES_VERSION,
                                   "The experiments and reports of the documents behind Hermes.",
                                   {experiments::addExperimentCommand, experiments::addReportCommand}};
    return line.run(argc, argv);
}
