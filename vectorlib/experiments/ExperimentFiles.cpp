#include "vectorlib/experiments/ExperimentCommand.h"

#include "common/progress/Progress.h"
#include "common/world/WorldFile.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/Options.h"
#include "vectorlib/experiments/Gnuplot.h"
#include "vectorlib/io/LatexExport.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>

namespace hermes::experiments {

using vector::Failure;
using vector::Input;
using vector::valueOrFail;

namespace fs = std::filesystem;

void ExperimentCommand::tell(std::ostream &json, const nlohmann::ordered_json &summary) {
    const std::string text = summary.dump(2) + '\n';
    json << text;
    std::cout << text;
}

std::ostream &ExperimentCommand::open(OutputSet &files, const std::string &suffix) const {
    return files.open((fs::u8path(folder) / (name + suffix)).u8string());
}

World ExperimentCommand::world(const std::string &place) const {
    Outcome<World> found = readWorld((fs::u8path(worlds) / (place + ".json")).u8string());
    if (!found)
        throw Failure(found.error() + "; --worlds names the folder of the worlds");
    found->name = place; // whatever it calls itself: the name goes into scripts and documents
    return *found;
}

std::vector<World> ExperimentCommand::allWorlds() const {
    std::vector<World> all;
    for (const char *place : {"corner", "cutsquare", "home", "oblique", "pillars", "quadratic"})
        all.push_back(world(place));
    return all;
}

vectorlib::CarmenLog ExperimentCommand::readLog() const {
    if (logs.size() != 1)
        throw CLI::ValidationError("--log", "the experiment " + name + " needs the name of a CARMEN log");
    return readLog(logs[0]);
}

vectorlib::CarmenLog ExperimentCommand::readLog(const std::string &file) {
    Input input(file);
    if (input.isCapture())
        throw Failure(file + ": found a capture, this experiment needs a CARMEN log");
    return valueOrFail(vectorlib::readCarmenLog(input.stream(), input.name()));
}

vectorlib::CarmenLog ExperimentCommand::readPairs(const std::string &file, const PairsOptions &of) const {
    vectorlib::CarmenLog log = readLog(file);
    if (of.pairsOf(log).empty())
        throw Failure(file + ": found " + std::to_string(log.scans.size()) + " scans and among them no pair" +
                      (of.half == PairHalf::Both ? "" : " of this half") + ", expected more than --every " +
                      std::to_string(of.every));
    return log;
}

std::vector<std::string> ExperimentCommand::setNames(const std::vector<std::string> &files) {
    std::vector<std::string> names;
    for (const std::string &file : files) {
        fs::path path = fs::u8path(file).filename();
        if (path.extension() == ".gz")
            path = path.stem();
        std::string name = path.stem().u8string();
        for (char &c : name)
            if (!(c >= '0' && c <= '9') && !(c >= 'A' && c <= 'Z') && !(c >= 'a' && c <= 'z') && c != '.')
                c = '-';
        const auto other = std::find(names.begin(), names.end(), name);
        if (other != names.end())
            throw Failure(file + ": would be called " + name + " as is " +
                          files[std::size_t(other - names.begin())] + ", expected logs of different names");
        names.push_back(name);
    }
    return names;
}

void ExperimentCommand::draw(OutputSet &files, const Figures &figures, const std::string &suffix,
                             std::vector<NamedPicture> named) const {
    vectorlib::LatexExport document(open(files, suffix + ".tex"), name);
    for (auto &[which, picture] : named) {
        picture.write(open(files, suffix + (which.empty() ? "" : "-" + which) + ".svg"));
        document.picture(picture, {14, 9});
    }
    document.figures(figures);
    document.finish();
    bool drawn = true;
    Progress progress("drawing, figure");
    const std::size_t all = figures.plots.size() + figures.surfaces.size() + figures.spaces.size();
    std::size_t done = 0;
    const auto drawOne = [&](const auto &figure) {
        drawn = drawn && draw(files, suffix, figure);
        progress.update(double(++done), double(all));
    };
    for (const Plot &plot : figures.plots)
        if (vectorlib::latex::boxOf(plot)) // else there is nothing to show, as the document says
            drawOne(plot);
    for (const Surface &surface : figures.surfaces)
        drawOne(surface);
    for (const SpacePlot &space : figures.spaces)
        drawOne(space);
    if (!drawn)
        std::cerr << "hermes-vector: gnuplot is not installed: no pictures beside the CSV and LaTeX files\n";
}

template <typename Figure>
bool ExperimentCommand::draw(OutputSet &files, const std::string &suffix, const Figure &figure) const {
    std::ostringstream script;
    writeGnuplot(script, figure);
    const std::optional<std::string> svg = runGnuplot(script.str());
    if (svg)
        open(files, suffix + "-" + figure.name + ".svg") << *svg;
    return svg.has_value();
}

} // namespace hermes::experiments
