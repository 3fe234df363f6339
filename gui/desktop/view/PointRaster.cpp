#include "gui/desktop/view/PointRaster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hermes::desktop {

const QImage *PointRaster::draw(const PointPicture &wanted) {
    const QSize pixels = wanted.pixels;
    if (picture_.size() != pixels)
        picture_ = QImage(pixels, QImage::Format_ARGB32_Premultiplied);
    picture_.fill(Qt::transparent);
    const int width = pixels.width(), height = pixels.height();
    depths_.assign(std::size_t(width) * std::size_t(height), std::numeric_limits<float>::infinity());
    auto *const colours = reinterpret_cast<QRgb *>(picture_.bits()); // rows of 32 bits have no gaps
    const float *const m = wanted.matrix.constData();                // column by column
    const float half = float(wanted.pointSize) / 2;
    for (const CloudVertex &p : wanted.points) {
        const float w = m[3] * p.x + m[7] * p.y + m[11] * p.z + m[15];
        const float depth = m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14];
        if (depth < -w || w <= 0)
            continue; // nearer than the nearest that is drawn, or behind the eye
        const float x = (m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12]) / w;
        const float y = (m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13]) / w;
        if (!(std::abs(x) < 1.1F && std::abs(y) < 1.1F))
            continue;
        const int left = int(std::lround((x + 1) / 2 * float(width) - half));
        const int top = int(std::lround((1 - y) / 2 * float(height) - half));
        const QRgb colour = qRgb(p.colour[0], p.colour[1], p.colour[2]);
        for (int row = std::max(top, 0); row < std::min(top + wanted.pointSize, height); ++row)
            for (int column = std::max(left, 0); column < std::min(left + wanted.pointSize, width);
                 ++column) {
                const std::size_t at = std::size_t(row) * std::size_t(width) + std::size_t(column);
                if (w >= depths_[at])
                    continue;
                depths_[at] = w;
                colours[at] = colour;
            }
    }
    return &picture_;
}

} // namespace hermes::desktop
