#include "vectorlib/experiments/ExperimentCommand.h"

#include "vectorlib/experiments/SearchFigures.h"
#include "vectorlib/experiments/SearchStages.h"

namespace hermes::experiments {

void ExperimentCommand::potentialPairs(OutputSet &files, std::ostream &csv) const {
    std::ostream &latex = open(files, "-figures.tex");
    const std::vector<SearchFigure> figures = searchFigures(options.seed);
    for (const SearchFigure &figure : figures)
        writeSvg(open(files, "-" + figure.name + ".svg"), figure);
    writeLatex(latex, figures);
    std::vector<SearchScene> scenes = {searchScene(searchExample(), options.seed, searchExampleScans())};
    for (const char *place : {"pillars", "quadratic"})
        scenes.push_back(searchScene(world(place), options.seed));
    const std::vector<SearchStages> rows = searchStages(scenes, options);
    writeCsv(csv, rows);
    draw(files, {plotsOf(rows), {}, {}});
}

} // namespace hermes::experiments
