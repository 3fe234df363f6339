#pragma once

#include "gui/desktop/view/CloudCamera.h"
#include "gui/desktop/view/CloudModel.h"

#include <array>

class QPainter;

namespace hermes::desktop {

/// A point with its colour, as graphics processors take it.
struct CloudVertex {
    float x, y, z;
    std::array<quint8, 4> colour; // red, green, blue, opacity
};

/// What is seen of a cloud, whatever draws the points: their colours, the grid on the ground, the robot's
/// axes and the legend.
class CloudScene {
public:
    enum class Colouring { Height, Intensity };

    explicit CloudScene(const CloudModel &model)
        : model_(model) {}

    CloudCamera camera;
    Colouring colouring = Colouring::Height;

    /// Colours the points of the model anew.
    void update();
    const std::vector<CloudVertex> &vertices() const { return vertices_; }
    /// Counts the calls of update().
    quint64 revision() const { return revision_; }

    /// What lies behind the points: background and grid.
    void paintGround(QPainter &painter, const QSize &size) const;
    /// What stands before them: axes, legend, and what there is to say when there are none.
    void paintWords(QPainter &painter, const QSize &size) const;

private:
    void paintGrid(QPainter &painter, const QSize &size) const;
    void paintAxes(QPainter &painter, const QSize &size) const;
    void paintLegend(QPainter &painter, const QSize &size) const;

    const CloudModel &model_;
    std::vector<CloudVertex> vertices_;
    quint64 revision_ = 0;
};

} // namespace hermes::desktop
