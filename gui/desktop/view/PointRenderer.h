#pragma once

#include "gui/desktop/view/CloudScene.h"

#include <QImage>

namespace hermes::desktop {

/// What is to be drawn.
struct PointPicture {
    const std::vector<CloudVertex> &points;
    quint64 revision; ///< another one: the points have changed
    QMatrix4x4 matrix;
    QSize pixels;
    int pointSize; ///< in pixels
};

/// Draws points on nothing, the nearest before the others.
class PointRenderer {
public:
    virtual ~PointRenderer() = default;
    /// The picture is the renderer's until the next call; null: it cannot draw any more.
    virtual const QImage *draw(const PointPicture &picture) = 0;
    virtual bool isByOpenGl() const { return false; }
};

} // namespace hermes::desktop
