// What a map painter writes beside the map: where the robot is, how it was matched, what is not drawn.
#include "gui/desktop/Theme.h"
#include "gui/desktop/view/MapColours.h"
#include "gui/desktop/view/MapPainter.h"

#include <QPainter>
#include <QtMath>

namespace hermes::desktop {

void MapPainter::paintBox(QPainter &painter, const QRectF &box) const {
    QColor back = mapColours().background;
    back.setAlpha(220);
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(QPen(mapColours().grid, 1));
    painter.setBrush(back);
    painter.drawRoundedRect(box, 4, 4);
    painter.setBrush(Qt::NoBrush);
}

void MapPainter::paintScaleBar(QPainter &painter, double step_m) const {
    const double length = step_m * scale();
    const QPointF right(size_.width() - 12, size_.height() - 12), left = right - QPointF(length, 0);
    const QRectF text(left - QPointF(0, 26), QSizeF(length, 20));
    paintBox(painter, QRectF(text.topLeft(), right).adjusted(-6, 0, 6, 6));
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(mapColours().text, 2));
    painter.drawLine(left, right);
    for (const QPointF &end : {left, right})
        painter.drawLine(end - QPointF(0, 4), end);
    painter.drawText(text, Qt::AlignCenter,
                     step_m < 1 ? QObject::tr("%1 cm").arg(100 * step_m) : QObject::tr("%1 m").arg(step_m));
}

void MapPainter::paintNotice(QPainter &painter, int leftOut) const {
    QStringList lines;
    if (model_.ignored() > 0)
        lines.append(QObject::tr("%1 impossible values are not shown").arg(model_.ignored()));
    if (leftOut > 0)
        lines.append(QObject::tr("%1 more lines are not drawn").arg(leftOut));
    painter.setPen(theme::colour(Condition::Warning));
    painter.drawText(QRectF(12, 0, size_.width() / 2.0, size_.height() - 12), Qt::AlignLeft | Qt::AlignBottom,
                     lines.join('\n'));
}

QString fixedNumber(double value, int decimals) {
    const QString text = QString::number(value, 'f', decimals);
    return text.toDouble() == 0 && text.startsWith('-') ? text.mid(1) : text;
}

QString poseText(const Pose2D &pose) {
    return QObject::tr("x %1 m, y %2 m, %3°")
        .arg(fixedNumber(pose.x, 2))
        .arg(fixedNumber(pose.y, 2))
        .arg(fixedNumber(qRadiansToDegrees(vectorlib::wrapAngle(pose.theta)), 1));
}

QString uncertaintyText(const Covariance &covariance) {
    constexpr double normal95 = 1.96;
    const auto spread = [&](std::size_t at) { return normal95 * std::sqrt(qMax(0.0, covariance[at])); };
    return QObject::tr("± %1 m, ± %2 m, ± %3° (95 %)")
        .arg(spread(0), 0, 'f', spread(0) < 0.1 ? 3 : 2)
        .arg(spread(4), 0, 'f', spread(4) < 0.1 ? 3 : 2)
        .arg(qRadiansToDegrees(qMin(spread(8), M_PI)), 0, 'f', 1);
}

/// Where and how the robot was found; the second line is the outcome. A low view has room for no more.
QStringList MapPainter::matchLines() const {
    QStringList lines{poseText(*model_.pose())};
    lines.append(
        model_.trust()
            ? QObject::tr("%1, trust of the pose %2").arg(model_.outcome()).arg(*model_.trust(), 0, 'f', 2)
            : model_.outcome());
    constexpr int low = 300; // pixels
    if (size_.height() < low)
        return lines;
    lines.append(model_.covariance() ? uncertaintyText(*model_.covariance()) : QObject::tr("± unknown"));
    if (model_.outcome() == "matched")
        lines.append(QObject::tr("reliability %1, ambiguity %2 m²")
                         .arg(qBound(0.0, model_.reliability(), 1.0), 0, 'f', 2)
                         .arg(model_.ambiguity(), 0, 'g', 2));
    return lines;
}

// Where the robot is, and how far to trust that: numbers with a bar whose colour and length say the same.
void MapPainter::paintMatch(QPainter &painter) const {
    constexpr int outcomeLine = 1;
    const bool isLost = model_.outcome() == "lost";
    constexpr double doubtful = 0.5, unreliable = 0.1; // trust; reliability, of a matcher that tells no trust
    const double sure = isLost ? 0 : qBound(0.0, model_.trust().value_or(model_.reliability()), 1.0);
    const bool isDoubtful = sure < (model_.trust() ? doubtful : unreliable);
    const Freshness &age = model_.poseAge();
    const Condition condition = !age.isFresh() ? Condition::Unreachable
                                : isLost       ? Condition::Fault
                                : isDoubtful   ? Condition::Warning
                                               : Condition::Ready;
    QStringList lines = matchLines();
    const int struck = age.state() == Freshness::State::Silent ? lines.size() : 0; // what held once
    if (struck > 0)
        lines.append(age.text());
    const QFontMetrics metrics(painter.font());
    const int height = metrics.height();
    int width = metrics.horizontalAdvance(QObject::tr("x -00.00 m, y -00.00 m, -000.0°")); // stands still
    for (const QString &line : lines)
        width = qMax(width, metrics.horizontalAdvance(line));
    const QRectF box(12, 12, width + 24, lines.size() * height + 24);
    paintBox(painter, box);
    const QRectF bar = QRectF(box.left() + 8, box.bottom() - 14, box.width() - 16, 6);
    painter.setPen(Qt::NoPen);
    painter.setBrush(mapColours().grid);
    painter.drawRect(bar);
    painter.setBrush(theme::colour(condition));
    painter.drawRect(QRectF(bar.topLeft(), QSizeF(bar.width() * sure, bar.height())));
    painter.setBrush(Qt::NoBrush);
    for (int i = 0; i < lines.size(); ++i) {
        painter.setPen(!age.isFresh() || (isLost && i == outcomeLine) ? theme::colour(condition)
                                                                      : mapColours().text);
        QFont font = painter.font();
        font.setStrikeOut(i < struck);
        painter.setFont(font);
        painter.drawText(box.topLeft() + QPointF(8, 4 + i * height + metrics.ascent()), lines[i]);
    }
}

// What an operator must know who saw the map move, or looked elsewhere.
void MapPainter::paintCorrection(QPainter &painter) const {
    if (!model_.correction_m())
        return;
    const QString text = QObject::tr("map corrected: %1 m").arg(*model_.correction_m(), 0, 'f', 2);
    const QFontMetrics metrics(painter.font());
    constexpr int narrow = 640; // pixels: what stands in the corners leaves no room between
    QRectF box(0, size_.width() < narrow ? 6 * metrics.height() : 12, metrics.horizontalAdvance(text) + 24,
               metrics.height() + 12);
    box.moveLeft((size_.width() - box.width()) / 2);
    paintBox(painter, box);
    painter.setPen(mapColours().text);
    painter.drawText(box, Qt::AlignCenter, text);
}

} // namespace hermes::desktop
