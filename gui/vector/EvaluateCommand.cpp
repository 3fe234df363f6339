#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/Options.h"
#include "gui/vector/Output.h"
#include "gui/vector/evaluation/Evaluation.h"

#include <filesystem>

namespace hermes::vector {

namespace {

struct EvaluateCommand {
    std::string log, trajectory;
    OutputOptions output;

    void run() const {
        Outputs files(output);
        Input logInput(log), trajectoryInput(trajectory);
        const Evaluation evaluation(
            valueOrFail(vectorlib::readCarmenLog(logInput.stream(), logInput.name())),
            valueOrFail(vectorlib::readTum(trajectoryInput.stream(), trajectoryInput.name())),
            trajectoryInput.name());
        evaluation.expectSameDrive(logInput.name(), trajectoryInput.name(), std::cerr);
        files.out << evaluation.summary().dump(2) << '\n';
        files.draw([&] {
            return evaluation.picture(fileName(trajectory) + " beside the reference of " + fileName(log));
        });
        files.commit();
    }
    static std::string fileName(const std::string &path) {
        return std::filesystem::u8path(path).filename().u8string();
    }
};

} // namespace

void addEvaluateCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<EvaluateCommand>(
        app, "evaluate",
        "Errors of a trajectory beside a log's corrected poses: from pose to pose, and where a "
        "place is met again (JSON)",
        "hermes-vector evaluate intel.log.gz intel.tum --svg errors.svg");
    sub->add_option("LOG", command->log, "CARMEN log whose scan poses are a corrected reference")->required();
    sub->add_option("TRAJECTORY", command->trajectory,
                    "TUM file: stamp x y z qx qy qz qw; of as many poses as the log has scans, or poses at "
                    "the times of some scans")
        ->required();
    command->output.addTo(*sub, true);
}

} // namespace hermes::vector
