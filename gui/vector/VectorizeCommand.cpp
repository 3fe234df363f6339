#include "common/progress/Progress.h"
#include "gui/vector/Input.h"
#include "gui/vector/Options.h"
#include "gui/vector/Vectorizers.h"
#include "vectorlib/io/Svg.h"

#include <algorithm>
#include <iostream>
#include <numeric>

namespace hermes::vector {

namespace {

using Point = vectorlib::Vector2D<double>;
using vectorlib::Number;

/// A line and the points of the file that it stands for.
struct Row {
    int cluster;
    int first;
    int last;
    vectorlib::Line2D line;
    double sigma;
    vectorlib::LineSegment2D<double> segment;
};

struct VectorizeCommand {
    std::string in;
    std::string algorithm = "ftls";
    std::string search;
    vectorlib::VectorizerSettings settings;
    bool noSegment = false;
    OutputOptions output;
    SegmentOptions segment;

    void run() const {
        if (!search.empty() && algorithm != "aftls")
            throw CLI::ValidationError("--search", "--algorithm " + algorithm +
                                                       " searches no break points, expected aftls");
        vectorlib::EarSegmenter<double> segmenter;
        segmenter.settings = segment.over({});
        Outputs files(output);
        const std::vector<Point> points = loadPoints(in);
        const vectorlib::Segmentation clusters = noSegment ? oneCluster(points.size()) : segmenter(points);
        const std::vector<Row> rows = vectorize(points, clusters);
        files.out << "cluster,first,last,a,b,c,sigma,x1,y1,x2,y2\n";
        for (const Row &r : rows) {
            files.out << r.cluster << ',' << r.first << ',' << r.last;
            for (const double v : {r.line.a, r.line.b, r.line.c, r.sigma, r.segment.begin().x,
                                   r.segment.begin().y, r.segment.end().x, r.segment.end().y})
                files.out << ',' << Number(v);
            files.out << '\n';
        }
        files.draw([&] { return pictureOf(points, rows); });
        files.commit();
    }

    static vectorlib::Segmentation oneCluster(std::size_t count) {
        vectorlib::Segmentation s;
        s.labels.assign(count, 0);
        s.order.resize(count);
        std::iota(s.order.begin(), s.order.end(), 0);
        s.starts = {0, count};
        return s;
    }

    std::vector<Row> vectorize(const std::vector<Point> &points,
                               const vectorlib::Segmentation &clusters) const {
        const auto chosen = std::find_if(vectorizers().begin(), vectorizers().end(),
                                         [&](const NamedVectorizer &v) { return v.name == algorithm; });
        const Vectorize<double> vectorizer = search == "nelder-mead"
                                                 ? makeVectorizer<NelderMeadAftls, double>(settings)
                                                 : chosen->make(settings);
        std::vector<Row> rows;
        std::vector<Point> part;
        std::size_t without = 0;
        std::optional<Progress> progress("vectorizing, point");
        progress->update(0, double(clusters.order.size()));
        for (std::size_t c = 0; c < clusters.size(); ++c) {
            const int *order = clusters.order.data() + clusters.starts[c];
            part.clear();
            for (std::size_t i = 0; i < clusters.size(c); ++i)
                part.push_back(points[static_cast<std::size_t>(order[i])]);
            for (const vectorlib::VectorizedLine &l : vectorizer(part)) {
                if (!l.line.isValid()) {
                    ++without;
                    continue;
                }
                rows.push_back(
                    {static_cast<int>(c), order[l.first], order[l.last], l.line, l.sigma, l.segment});
            }
            progress->update(double(clusters.starts[c + 1]), double(clusters.order.size()));
        }
        progress.reset();
        if (without > 0)
            std::cerr << "hermes-vector: left out " << without
                      << " interval(s) of points that have no direction\n";
        return rows;
    }

    vectorlib::SvgPicture pictureOf(const std::vector<Point> &points, const std::vector<Row> &rows) const {
        vectorlib::SvgPicture picture(std::to_string(rows.size()) + " lines by " + algorithm + " from " +
                                      std::to_string(points.size()) + " points");
        picture.points({vectorlib::colour::points, 3, "points"}, points);
        std::vector<vectorlib::LineSegment2D<double>> segments;
        std::vector<Point> ends;
        for (const Row &r : rows) {
            segments.push_back(r.segment);
            ends.push_back(r.segment.begin());
            ends.push_back(r.segment.end());
        }
        picture.segments({vectorlib::colour::estimate, 2, "lines, with the side that was free", false, true},
                         segments);
        picture.points({vectorlib::colour::reference, 5, "their ends"}, ends);
        picture.pose({vectorlib::colour::map, 2, "sensor"}, {}, 0);
        return picture;
    }
};

} // namespace

void addVectorizeCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<VectorizeCommand>(
        app, "vectorize", "Replace points by line segments (CSV cluster,first,last,a,b,c,sigma,x1,y1,x2,y2)",
        "hermes-vector vectorize scan.csv --algorithm ftls --sigma 0.02 --polyline");
    sub->add_option("IN", command->in, "Points: CSV x,y or ascii PCD, in order of acquisition")->required();
    command->settings.polyline = false;
    std::vector<std::string> names;
    std::string help;
    for (const NamedVectorizer &v : vectorizers()) {
        names.push_back(v.name);
        help += (help.empty() ? "" : "; ") + v.name + ": " + v.help;
    }
    addOption(*sub, "--algorithm A", command->algorithm, CLI::IsMember(names), help)->capture_default_str();
    addOption(*sub, "--search KIND", command->search, CLI::IsMember({"descent", "nelder-mead"}),
              "With --algorithm aftls: how its break points are sought, one after the other downhill (the "
              "default) or as published, by Nelder and Mead");
    addOption(*sub, "--sigma M", command->settings.sigma, aboveZero(),
              "Largest standard deviation of points from their line, metres")
        ->capture_default_str();
    addOption(*sub, "--delta M", command->settings.delta, aboveZero(),
              "With --polyline: farthest a corner may lie from where two lines change, metres")
        ->capture_default_str();
    sub->add_flag("--no-segment", command->noSegment, "The whole file is one open cluster");
    sub->add_flag("--polyline", command->settings.polyline,
                  "Join the consecutive lines of a cluster where they cross");
    command->segment.addTo(*sub, "defaults 10, 0.05, 0.20, 15");
    command->output.addTo(*sub, true);
}

} // namespace hermes::vector
