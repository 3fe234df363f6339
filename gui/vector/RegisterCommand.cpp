#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/NearFrames.h"
#include "gui/vector/Options.h"
#include "vectorlib/io/Csv.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <nlohmann/json.hpp>

#include <iostream>

namespace hermes::vector {

namespace {

using Segment = vectorlib::LineSegment2D<double>;
using vectorlib::SegmentPair;

struct RegisterCommand {
    std::string in;
    std::string rotation = "mitsuta";
    std::string weights = "none";
    vectorlib::Stiffness stiffness;
    OutputOptions output;

    void run() const {
        Outputs files(output);
        Input input(in);
        const vectorlib::PairTable table = valueOrFail(vectorlib::readCsvPairs(input.stream(), input.name()));
        if (weights == "column" && !table.hasWeights)
            throw Failure(input.name() + ":1: found no column weight, which --weights column expects");

        vectorlib::LineSegmentRegistration registration;
        registration.rotation =
            rotation == "wahba" ? vectorlib::Rotation::Wahba : vectorlib::Rotation::Mitsuta;
        registration.stiffness = stiffness;
        const NearFrames frames(table.pairs);
        for (SegmentPair p : table.pairs) {
            p.weight = weightOf(p);
            if (!registration.add(frames.toNear(p)))
                throw Failure(input.name() +
                              ": found segments or weights that are far too large, expected metres");
        }
        const vectorlib::Transformation2D t = frames.fromNear(registration.transformation());
        if (!registration.isSolvable())
            std::cerr
                << "hermes-vector: all lines are parallel: the shift along them is not known and left at 0\n";
        write(files.out, registration, t);
        files.draw([&] { return pictureOf(table.pairs, t); });
        files.commit();
    }

    double weightOf(const SegmentPair &p) const {
        return weights == "length"   ? std::min(p.fixed.length(), p.moving.length())
               : weights == "column" ? p.weight
                                     : 1;
    }
    static void write(std::ostream &out, const vectorlib::LineSegmentRegistration &registration,
                      const vectorlib::Transformation2D &t) {
        const vectorlib::Ambiguity ambiguity = registration.ambiguity();
        nlohmann::ordered_json json;
        json["x"] = t.x();
        json["y"] = t.y();
        json["alpha"] = t.alpha();
        json["reliability"] = registration.reliability();
        json["ambiguity"] = ambiguity.total();
        json["ambiguity_xy"] = ambiguity.xy;
        json["ambiguity_alpha"] = ambiguity.alpha;
        json["pairs"] = registration.pairs();
        out << json.dump(2) << '\n';
    }
    static vectorlib::SvgPicture pictureOf(const std::vector<SegmentPair> &pairs,
                                           const vectorlib::Transformation2D &t) {
        std::vector<Segment> fixed, before, after;
        for (const SegmentPair &p : pairs) {
            fixed.push_back(p.fixed);
            before.push_back(p.moving);
            after.push_back(t * p.moving);
        }
        vectorlib::SvgPicture picture("Registration of " + std::to_string(pairs.size()) +
                                      " pairs of segments");
        picture.segments({vectorlib::colour::map, 4, "static set"}, fixed);
        picture.segments({vectorlib::colour::before, 1.5, "dynamic set as given", true}, before);
        picture.segments({vectorlib::colour::estimate, 1.5, "dynamic set moved onto the static one"}, after);
        return picture;
    }
};

} // namespace

void addRegisterCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<RegisterCommand>(
        app, "register", "Find the motion that brings segments onto their known partners (JSON)",
        "hermes-vector register pairs.csv --weights length");
    sub->add_option("IN", command->in,
                    "Pairs: CSV sx1,sy1,sx2,sy2,dx1,dy1,dx2,dy2[,weight]; static, then dynamic")
        ->required();
    addOption(*sub, "--rotation HOW", command->rotation, CLI::IsMember({"mitsuta", "wahba"}),
              "How the rotation is averaged: mitsuta or wahba")
        ->capture_default_str();
    addOption(*sub, "--weights HOW", command->weights, CLI::IsMember({"none", "length", "column"}),
              "none, length (of the shorter segment) or column (weight)")
        ->capture_default_str();
    addOption(*sub, "--k-alpha K", command->stiffness.alpha, between(0, 1e12),
              "Weight of the rotation in the ambiguity, m^2/rad^2")
        ->capture_default_str();
    addOption(*sub, "--k-xy K", command->stiffness.xy, between(0, 1e12),
              "Weight of the translation in the ambiguity")
        ->capture_default_str();
    command->output.addTo(*sub, true);
}

} // namespace hermes::vector
