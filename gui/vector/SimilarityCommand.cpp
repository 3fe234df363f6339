#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/NearFrames.h"
#include "gui/vector/Options.h"
#include "vectorlib/io/Csv.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/similarity/EdgeSetComparator.h"

namespace hermes::vector {

namespace {

struct SimilarityCommand {
    std::string in;
    std::vector<std::string> poses;
    OutputOptions output;

    void run() const {
        using vectorlib::Number;
        Outputs files(output);
        Input input(in);
        const vectorlib::PairTable table = valueOrFail(vectorlib::readCsvPairs(input.stream(), input.name()));
        const NearFrames frames(table.pairs);
        vectorlib::EdgeSetComparator criterion;
        for (const vectorlib::SegmentPair &p : table.pairs)
            if (!criterion.add(frames.toNear(p)))
                throw Failure(input.name() +
                              ": found segments or weights that are far too large, expected metres");
        files.out << "x,y,alpha,criterion\n";
        for (const std::string &text : poses) {
            const vectorlib::Pose2D pose = parsePose(text);
            files.out << Number(pose.x) << ',' << Number(pose.y) << ',' << Number(pose.theta) << ','
                      << Number(criterion(frames.toNear(vectorlib::Transformation2D(pose)))) << '\n';
        }
        files.commit();
    }
};

} // namespace

void addSimilarityCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<SimilarityCommand>(
        app, "similarity",
        "How much segments differ from their known partners under motions (CSV x,y,alpha,criterion)",
        "hermes-vector similarity pairs.csv --pose 0,0,0 --pose 1,-2,0.3");
    sub->add_option("IN", command->in,
                    "Pairs: CSV sx1,sy1,sx2,sy2,dx1,dy1,dx2,dy2[,weight]; static, then dynamic")
        ->required();
    sub->add_option("--pose", command->poses,
                    "Motion of the dynamic set: metres, radians; may be given again")
        ->required()
        ->check(poseText())
        ->allow_extra_args(false) // what follows one is not another
        ->type_name("X,Y,ALPHA");
    command->output.addTo(*sub, false);
}

} // namespace hermes::vector
