#pragma once

#include "gui/desktop/view/PointRenderer.h"

namespace hermes::desktop {

/// Draws points without a graphics processor.
class PointRaster : public PointRenderer {
public:
    const QImage *draw(const PointPicture &picture) override;

private:
    QImage picture_;
    std::vector<float> depths_; // of each pixel
};

} // namespace hermes::desktop
