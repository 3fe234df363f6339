#include "gui/vector/Options.h"
#include "gui/vector/Points.h"
#include "vectorlib/io/Svg.h"

namespace hermes::vector {

namespace {

using Point = vectorlib::Vector2D<double>;

struct SegmentCommand {
    std::string in;
    OutputOptions output;
    SegmentOptions segment;

    void run() const {
        vectorlib::EarSegmenter<double> segmenter;
        segmenter.settings = segment.over({});
        OutputSet files(output.force);
        std::ostream &out = files.open(output.out);
        std::ostream *svg = output.svg.empty() ? nullptr : &files.open(output.svg);
        const std::vector<Point> points = loadPoints(in);
        const vectorlib::Segmentation &clusters = segmenter(points);
        out << "index,cluster\n";
        for (std::size_t i = 0; i < clusters.labels.size(); ++i)
            out << i << ',' << clusters.labels[i] << '\n';
        if (svg)
            draw(*svg, points, clusters);
        files.commit();
    }

    static void draw(std::ostream &svg, const std::vector<vectorlib::Vector2D<double>> &points,
                     const vectorlib::Segmentation &clusters) {
        vectorlib::SvgPicture picture(std::to_string(clusters.size()) + " clusters in " +
                                      std::to_string(points.size()) + " points");
        std::vector<vectorlib::Vector2D<double>> part;
        for (std::size_t c = 0; c < clusters.size(); ++c) {
            part.clear();
            for (std::size_t i = clusters.starts[c]; i < clusters.starts[c + 1]; ++i)
                part.push_back(points[static_cast<std::size_t>(clusters.order[i])]);
            // A legend of a dozen rows is still read; beyond that clusters speak for themselves.
            const bool named = clusters.size() <= 12;
            picture.points(
                {vectorlib::colour::distinct(c), 3,
                 named ? "cluster " + std::to_string(c) + ": " + std::to_string(part.size()) + " points"
                       : ""},
                part);
        }
        part.clear();
        for (std::size_t i = 0; i < points.size(); ++i)
            if (clusters.labels[i] < 0)
                part.push_back(points[i]);
        picture.points({vectorlib::colour::outliers, 3, std::to_string(part.size()) + " outliers"}, part);
        picture.pose({vectorlib::colour::map, 2, "sensor"}, {}, 0);
        picture.write(svg);
    }
};

} // namespace

void addSegmentCommand(CLI::App &app) {
    auto command = std::make_shared<SegmentCommand>();
    CLI::App *sub = app.add_subcommand(
        "segment", "Split a scan into clusters of neighbouring points (CSV index,cluster; -1 is "
                   "an outlier)");
    sub->add_option("IN", command->in, "Points: CSV x,y or ascii PCD, in order of acquisition")->required();
    command->segment.addTo(*sub, "defaults 10, 0.05, 0.20, 15");
    command->output.addTo(*sub, true);
    sub->footer(example("hermes-vector segment scan.csv --open --svg scan.svg"));
    sub->callback([command] { command->run(); });
}

} // namespace hermes::vector
