#include "common/progress/Progress.h"
#include "gui/vector/Input.h"
#include "gui/vector/Options.h"
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
        Outputs files(output);
        const std::vector<Point> points = loadPoints(in);
        const vectorlib::Segmentation &clusters = segmenter(points);
        files.out << "index,cluster\n";
        const std::size_t rows = clusters.labels.size();
        std::optional<Progress> progress("writing, row");
        for (std::size_t i = 0; i < rows; ++i) {
            files.out << i << ',' << clusters.labels[i] << '\n';
            if (i % 4096 == 0 || i + 1 == rows)
                progress->update(double(i + 1), double(rows));
        }
        progress.reset();
        files.draw([&] { return pictureOf(points, clusters); });
        files.commit();
    }

    static vectorlib::SvgPicture pictureOf(const std::vector<Point> &points,
                                           const vectorlib::Segmentation &clusters) {
        vectorlib::SvgPicture picture(std::to_string(clusters.size()) + " clusters in " +
                                      std::to_string(points.size()) + " points");
        std::vector<std::vector<Point>> parts(clusters.size());
        for (std::size_t c = 0; c < clusters.size(); ++c)
            for (std::size_t i = clusters.starts[c]; i < clusters.starts[c + 1]; ++i)
                parts[c].push_back(points[static_cast<std::size_t>(clusters.order[i])]);
        picture.clusters(3, parts);
        std::vector<Point> outliers;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (clusters.labels[i] < 0)
                outliers.push_back(points[i]);
        picture.points({vectorlib::colour::outliers, 3, std::to_string(outliers.size()) + " outliers"},
                       outliers);
        picture.pose({vectorlib::colour::map, 2, "sensor"}, {}, 0);
        return picture;
    }
};

} // namespace

void addSegmentCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<SegmentCommand>(
        app, "segment",
        "Split a scan into clusters of neighbouring points (CSV index,cluster; -1 is "
        "an outlier)",
        "hermes-vector segment scan.csv --open --svg scan.svg");
    sub->add_option("IN", command->in, "Points: CSV x,y or ascii PCD, in order of acquisition")->required();
    command->segment.addTo(*sub, "defaults 10, 0.05, 0.20, 15");
    command->output.addTo(*sub, true);
}

} // namespace hermes::vector
