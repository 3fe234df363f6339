#include "gui/desktop/drive/Stick.h"

#include "gui/desktop/Theme.h"

#include <QMouseEvent>
#include <QPainter>
#include <QtMath>

namespace hermes::desktop {
namespace {

constexpr double innerShare = 0.68;            // of the radius belongs to the knob, the rest to the ring
constexpr double fullTurn = vectorlib::pi / 3; // of the ring is the whole rate of turn

} // namespace

Stick::Stick(QWidget *parent)
    : QWidget(parent) {
    setMinimumSize(96, 96);
}

void Stick::paintEvent(QPaintEvent *) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(width() / 2.0, height() / 2.0);
    const double r = radius(), inner = innerShare * r;
    const QColor line =
        palette().color(isEnabled() ? QPalette::Active : QPalette::Disabled, QPalette::WindowText);
    const QColor active = theme::colour(isEnabled() ? Condition::Busy : Condition::Unreachable);
    QColor faint = line;
    faint.setAlpha(60);
    painter.setPen(QPen(faint, 1));
    painter.setBrush(palette().base());
    painter.drawEllipse(QPointF(), r, r);
    painter.drawEllipse(QPointF(), inner, inner);
    painter.drawLine(QPointF(-inner, 0), QPointF(inner, 0));
    painter.drawLine(QPointF(0, -inner), QPointF(0, inner));

    const double middle = (r + inner) / 2;
    QColor swept = active;
    swept.setAlpha(120);
    painter.setPen(QPen(swept, r - inner, Qt::SolidLine, Qt::FlatCap));
    painter.drawArc(QRectF(-middle, -middle, 2 * middle, 2 * middle), 90 * 16,
                    qRound(turn_ * qRadiansToDegrees(fullTurn) * 16));
    painter.setPen(Qt::NoPen);
    painter.setBrush(active);
    painter.rotate(-qRadiansToDegrees(turn_ * fullTurn));
    painter.drawEllipse(QPointF(0, -middle), (r - inner) / 3, (r - inner) / 3);
    painter.rotate(qRadiansToDegrees(turn_ * fullTurn));
    const double knob = 0.28 * r;
    painter.drawEllipse(knob_ * (inner - knob), knob, knob);
}

void Stick::mousePressEvent(QMouseEvent *event) {
    const QPointF at = fromCentre(event->localPos());
    const double distance = std::hypot(at.x(), at.y());
    if (event->button() != Qt::LeftButton || distance > radius() + 4)
        return;
    grip_ = distance > innerShare * radius() ? Grip::Ring : Grip::Knob;
    grabbed_ = std::atan2(-at.y(), at.x());
    mouseMoveEvent(event);
}

void Stick::mouseMoveEvent(QMouseEvent *event) {
    const QPointF at = fromCentre(event->localPos());
    if (grip_ == Grip::Knob) {
        const QPointF knob = at / (innerShare * 0.6 * radius());
        knob_ = knob / std::max(1.0, std::hypot(knob.x(), knob.y()));
    } else if (grip_ == Grip::Ring) {
        const double turned = std::remainder(std::atan2(-at.y(), at.x()) - grabbed_, 2 * vectorlib::pi);
        turn_ = qBound(-1.0, turned / fullTurn, 1.0);
    } else {
        return;
    }
    Q_EMIT moved({-knob_.y(), -knob_.x(), turn_}, true);
    update();
}

void Stick::mouseReleaseEvent(QMouseEvent *event) {
    if (event->button() == Qt::LeftButton)
        letGo();
}

void Stick::changeEvent(QEvent *event) {
    if (event->type() == QEvent::EnabledChange && !isEnabled())
        letGo(); // the release of the button will not be heard
    QWidget::changeEvent(event);
}

void Stick::letGo() {
    grip_ = Grip::None;
    knob_ = {};
    turn_ = 0;
    Q_EMIT moved({}, false);
    update();
}

} // namespace hermes::desktop
