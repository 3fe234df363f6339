#include "gui/desktop/view/CloudScene.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/view/MapColours.h"
#include "gui/desktop/view/MapPainter.h"

#include <QPainter>
#include <QVector4D>
#include <optional>

namespace hermes::desktop {
namespace {

/// A line in space on the screen; nothing: it lies behind the eye.
std::optional<QLineF> onScreen(const QMatrix4x4 &matrix, const QSize &size, const QVector3D &from,
                               const QVector3D &to) {
    constexpr float nearest = 1e-3F;
    QVector4D ends[] = {matrix * QVector4D(from, 1), matrix * QVector4D(to, 1)};
    if (ends[0].w() < nearest && ends[1].w() < nearest)
        return std::nullopt;
    for (int i : {0, 1})
        if (const QVector4D other = ends[1 - i]; ends[i].w() < nearest)
            ends[i] += (other - ends[i]) * ((nearest - ends[i].w()) / (other.w() - ends[i].w()));
    const auto pixel = [&](const QVector4D &end) {
        const float x = end.x() / end.w(), y = end.y() / end.w();
        return QPointF(double(x + 1) / 2 * size.width(), double(1 - y) / 2 * size.height());
    };
    return QLineF(pixel(ends[0]), pixel(ends[1]));
}

/// Of all colours from low to high.
std::array<QColor, 256> colourTable() {
    const std::array<QColor, 5> stops = cloudColours();
    std::array<QColor, 256> table;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double at = double(i) / double(table.size() - 1) * (stops.size() - 1);
        const std::size_t stop = std::min(std::size_t(at), stops.size() - 2);
        table[i] = theme::mixed(stops[stop], stops[stop + 1], at - double(stop));
    }
    return table;
}

std::array<quint8, 4> bytesOf(const QColor &colour) {
    return {quint8(colour.red()), quint8(colour.green()), quint8(colour.blue()), quint8(255)};
}

} // namespace

void CloudScene::update() {
    std::array<std::array<quint8, 4>, 256> colours{};
    const auto table = colourTable();
    const bool isOld = !model_.age().isFresh(); // grey: that is not where things are now
    for (std::size_t i = 0; i < colours.size(); ++i)
        colours[i] = bytesOf(isOld ? theme::colour(Condition::Unreachable) : table[i]);
    const float lowest = model_.lowest_m(), scale = 255 / (model_.highest_m() - lowest);
    vertices_.clear();
    for (const CloudPoint &point : model_.points()) {
        const float value =
            colouring == Colouring::Height ? (point.z - lowest) * scale : float(point.intensity);
        vertices_.push_back(
            {point.x, point.y, point.z, colours[std::size_t(std::clamp(value, 0.0F, 255.0F))]});
    }
    ++revision_;
}

void CloudScene::paintGround(QPainter &painter, const QSize &size) const {
    painter.fillRect(QRect({}, size), mapColours().background);
    paintGrid(painter, size);
}

// On the lowest of what is seen, around the sensor.
void CloudScene::paintGrid(QPainter &painter, const QSize &size) const {
    const double wanted = camera.distance_m() / 10;
    const float step = wanted > 10 ? 50 : wanted > 2 ? 10 : wanted > 0.8 ? 2 : 1;
    constexpr int lines = 20;
    const float reach = step * lines, ground = model_.lowest_m();
    const QMatrix4x4 matrix = camera.matrix(size);
    painter.setRenderHint(QPainter::Antialiasing, false);
    for (int i = -lines; i <= lines; ++i) {
        const float at = step * float(i);
        painter.setPen(QPen(i == 0 ? mapColours().axis : mapColours().grid, 0));
        for (const auto &line : {onScreen(matrix, size, {at, -reach, ground}, {at, reach, ground}),
                                 onScreen(matrix, size, {-reach, at, ground}, {reach, at, ground})})
            if (line)
                painter.drawLine(*line);
    }
    painter.setPen(mapColours().text);
    painter.drawText(QRectF(12, 0, size.width() - 24, size.height() - 8), Qt::AlignLeft | Qt::AlignBottom,
                     QObject::tr("grid %1 m").arg(double(step)));
}

void CloudScene::paintAxes(QPainter &painter, const QSize &size) const {
    const QMatrix4x4 matrix = camera.matrix(size);
    const float length = float(camera.distance_m() / 8);
    const struct {
        QVector3D way;
        QString name;
    } axes[] = {
        {{1, 0, 0}, QObject::tr("ahead")}, {{0, 1, 0}, QObject::tr("left")}, {{0, 0, 1}, QObject::tr("up")}};
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(QPen(mapColours().robot, 2));
    for (const auto &axis : axes)
        if (const auto line = onScreen(matrix, size, {}, length * axis.way)) {
            painter.drawLine(*line);
            // "up" and "ahead" often end near each other.
            const bool isUp = axis.way.z() > 0;
            const double left = isUp ? -3 - painter.fontMetrics().horizontalAdvance(axis.name) : 3;
            painter.drawText(line->p2() + QPointF(left, -3), axis.name);
        }
    painter.setRenderHint(QPainter::Antialiasing, false);
}

void CloudScene::paintWords(QPainter &painter, const QSize &size) const {
    paintAxes(painter, size);
    if (!model_.points().empty())
        return paintLegend(painter, size);
    painter.setPen(mapColours().text);
    const bool isNobody = !model_.source() && model_.age().state() == Freshness::State::None;
    painter.drawText(
        QRect({}, size).adjusted(40, 20, -40, -20), Qt::AlignCenter | Qt::TextWordWrap,
        isNobody ? QObject::tr("No cloud. It comes as soon as a lidar logger of this robot is connected.")
                 : QObject::tr("No points as yet. They come as soon as the lidar turns."));
}

void CloudScene::paintLegend(QPainter &painter, const QSize &size) const {
    const bool isHeight = colouring == Colouring::Height;
    const auto metres = [](float value) { return QObject::tr("%1 m").arg(fixedNumber(double(value), 1)); };
    const QString low = isHeight ? metres(model_.lowest_m()) : "0";
    const QString high = isHeight ? metres(model_.highest_m()) : "255";
    const QFontMetrics metrics(painter.font());
    const int height = metrics.height(), width = 180;
    const QRect box(size.width() - width - 20, 8, width + 12, 2 * height + 22);
    QColor back = mapColours().background;
    back.setAlpha(220);
    painter.fillRect(box, back);
    painter.setPen(mapColours().text);
    const QRect words = box.adjusted(6, 4, -6, -4);
    painter.drawText(words, Qt::AlignHCenter | Qt::AlignTop,
                     isHeight ? QObject::tr("above the lidar") : QObject::tr("light that came back"));
    painter.drawText(words, Qt::AlignLeft | Qt::AlignBottom, low);
    painter.drawText(words, Qt::AlignRight | Qt::AlignBottom, high);
    const auto table = colourTable();
    for (int x = 0; x < width; ++x)
        painter.fillRect(words.left() + x, words.top() + height + 2, 1, 10,
                         table[std::size_t(x * 255 / (width - 1))]);
}

} // namespace hermes::desktop
