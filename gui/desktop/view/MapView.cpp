#include "gui/desktop/view/MapView.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/view/MapColours.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <QtMath>

namespace hermes::desktop {

MapView::MapView(const MapModel &model, QWidget *parent)
    : QWidget(parent)
    , model_(model)
    , cursorLabel_(new PlainLabel({}, this)) {
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setMinimumSize(200, 100);
    setAttribute(Qt::WA_OpaquePaintEvent);
    cursorLabel_->setObjectName("cursor");
    cursorLabel_->setToolTip(tr("Under the mouse: x and y on the map, in metres"));
    cursorLabel_->setAutoFillBackground(
        true); // so that the map is not drawn anew with each move of the mouse
    cursorLabel_->setAttribute(Qt::WA_TransparentForMouseEvents);
    cursorLabel_->setMargin(2);
    cursorLabel_->hide();
    connect(&model, &MapModel::changed, this, &MapView::refresh);
}

QTransform MapView::transform() const {
    QTransform t;
    t.translate(width() / 2.0, height() / 2.0);
    t.scale(pixelsPerMetre_, -pixelsPerMetre_);
    t.translate(-centre_.x(), -centre_.y());
    return t;
}

void MapView::refresh() {
    const DaemonLink *const matcher = model_.matcher();
    if (matcher && fitted_ != matcher && !model_.edges().isEmpty() && model_.isWhole()) {
        if (model_.pose())
            fitted_ = matcher;
        isUntouched_ = true;
        showFirst();
    }
    if (isFitting_ && !showsAll())
        showAll();
    if (const auto pose = model_.shownPose(); isFollowing_ && pose)
        centre_ = QPointF(pose->x, pose->y);
    tellCursor();
    update();
}

// A label of its own: what is under the mouse changes far more often than the map.
void MapView::tellCursor() {
    cursorLabel_->setVisible(cursor_.has_value());
    if (!cursor_)
        return;
    QPalette colours = cursorLabel_->palette();
    colours.setColor(QPalette::Window, mapColours().background);
    colours.setColor(QPalette::WindowText, mapColours().text);
    if (colours != cursorLabel_->palette())
        cursorLabel_->setPalette(colours);
    const QPointF at = toWorld(*cursor_);
    const int decimals = pixelsPerMetre_ > 100 ? 3 : 2;
    cursorLabel_->setText(
        tr("x %1 m, y %2 m").arg(fixedNumber(at.x(), decimals)).arg(fixedNumber(at.y(), decimals)));
    cursorLabel_->resize(cursorLabel_->sizeHint());
    constexpr int scaleBar = 42; // its height, and that of its text
    cursorLabel_->move(width() - 12 - cursorLabel_->width(), height() - scaleBar - cursorLabel_->height());
}

void MapView::leaveEvent(QEvent *) {
    cursor_.reset();
    tellCursor();
}

void MapView::setTool(Tool tool) {
    tool_ = tool;
    pressed_.reset();
    setCursor(tool == Tool::Pan ? Qt::ArrowCursor : Qt::CrossCursor);
    Q_EMIT toolChanged();
    update();
}

void MapView::setFollowing(bool isFollowing) {
    if (isFollowing_ == isFollowing)
        return;
    isFollowing_ = isFollowing;
    Q_EMIT followingChanged(isFollowing);
    if (isFollowing)
        setFitting(false);
    refresh();
}

void MapView::setFitting(bool isFitting) {
    if (isFitting) {
        setFollowing(false);
        showAll();
    }
    if (isFitting_ != isFitting)
        Q_EMIT fittingChanged(isFitting_ = isFitting);
}

// And not so small, as where another map was begun, that it had better be shown larger.
bool MapView::showsAll() const {
    const QRectF all = transform().mapRect(model_.bounds());
    constexpr double least = 0.3; // of the view
    const bool isSmall = all.width() < least * width() && all.height() < least * height();
    return model_.bounds().isNull() || (QRectF(rect()).contains(all) && !isSmall);
}

/// The operator wants to see it so.
void MapView::keepScale() {
    fitted_ = model_.matcher();
    isUntouched_ = false;
}

/// The whole map, with the robot in the middle if the view follows it.
void MapView::showFirst() {
    showAll();
    const auto pose = model_.shownPose();
    const QRectF all = model_.bounds();
    if (!isFollowing_ || !pose || !all.isValid())
        return;
    const double across = 2 * qMax(pose->x - all.left(), all.right() - pose->x);
    const double along = 2 * qMax(pose->y - all.top(), all.bottom() - pose->y);
    fitTo(across, along);
    centre_ = QPointF(pose->x, pose->y);
}

void MapView::showAll() {
    const QRectF all = model_.bounds();
    if (all.isNull())
        return;
    fitTo(all.width(), all.height());
    centre_ = all.center();
    update();
}

/// So that so many metres are seen.
void MapView::fitTo(double across_m, double along_m) {
    constexpr double margin = 1.15;
    fittedSize_ = size();
    pixelsPerMetre_ = qBound(
        0.5, qMin(width() / qMax(1.0, margin * across_m), height() / qMax(1.0, margin * along_m)), 5000.0);
}

void MapView::zoomAt(QPointF pixel, double factor) {
    setFitting(false);
    keepScale();
    const QPointF fixed = toWorld(pixel);
    pixelsPerMetre_ = qBound(0.5, pixelsPerMetre_ * factor, 5000.0);
    if (!isFollowing_)
        centre_ += fixed - toWorld(pixel);
    tellCursor();
    update();
}

void MapView::paintEvent(QPaintEvent *) {
    QPainter painter(this);
    render(painter);
    paintTool(painter);
    if (model_.edges().isEmpty() && !model_.pose() && model_.scan().isEmpty()) {
        painter.setPen(palette().color(QPalette::PlaceholderText));
        painter.drawText(rect().adjusted(40, 40, -40, -40), Qt::AlignCenter | Qt::TextWordWrap,
                         tr("No map yet. It grows as soon as a scan matcher of this robot gets scans."));
    }
}

void MapView::paintTool(QPainter &painter) const {
    if (!pressed_ || tool_ == Tool::Pan)
        return;
    const QLineF line(*pressed_, dragged_);
    const QLineF shown = transform().map(line);
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(QPen(theme::colour(Condition::Fault), 2));
    painter.drawLine(shown);
    const double degrees = qRadiansToDegrees(std::atan2(line.dy(), line.dx()));
    const QString text = tool_ == Tool::Measure ? tr("%1 m").arg(line.length(), 0, 'f', 3)
                                                : tr("%1 m, %2 m, %3°")
                                                      .arg(line.x1(), 0, 'f', 2)
                                                      .arg(line.y1(), 0, 'f', 2)
                                                      .arg(degrees, 0, 'f', 0);
    painter.drawText(shown.p2() + QPointF(10, -10), text);
}

void MapView::wheelEvent(QWheelEvent *event) {
    zoomAt(event->position(), std::pow(step, event->angleDelta().y() / 120.0));
}

void MapView::mousePressEvent(QMouseEvent *event) {
    if (event->button() != Qt::LeftButton)
        return;
    pressed_ = tool_ == Tool::Pan ? event->localPos() : toWorld(event->localPos());
    dragged_ = toWorld(event->localPos());
}

void MapView::mouseMoveEvent(QMouseEvent *event) {
    cursor_ = event->pos();
    tellCursor();
    if (!pressed_ || !(event->buttons() & Qt::LeftButton))
        return;
    if (tool_ == Tool::Pan) {
        const QPointF way = event->localPos() - *pressed_;
        if ((isFollowing_ || isFitting_) && way.manhattanLength() < 4)
            return; // a click is no wish to look elsewhere
        setFollowing(false);
        setFitting(false);
        keepScale();
        centre_ -= QPointF(way.x(), -way.y()) / pixelsPerMetre_;
        pressed_ = event->localPos();
    } else {
        dragged_ = toWorld(event->localPos());
        if (tool_ == Tool::Measure)
            Q_EMIT measured(QLineF(*pressed_, dragged_).length());
    }
    update();
}

void MapView::mouseReleaseEvent(QMouseEvent *event) {
    if (event->button() != Qt::LeftButton || !pressed_)
        return;
    const QLineF way(*pressed_, toWorld(event->localPos()));
    if (tool_ == Tool::Place) {
        const double now = model_.pose() ? model_.pose()->theta : 0;
        const bool isDragged = way.length() * pixelsPerMetre_ > 8;
        Q_EMIT placed({way.x1(), way.y1(), isDragged ? std::atan2(way.dy(), way.dx()) : now});
        setTool(Tool::Pan);
    } else if (tool_ == Tool::Pan) {
        pressed_.reset();
    } else {
        dragged_ = way.p2(); // the distance stays until the next press
        Q_EMIT measured(way.length());
    }
    update();
}

/// A note below the map makes it lower by a line or two: that is no reason for another scale.
void MapView::resizeEvent(QResizeEvent *) {
    constexpr int some = 5; // the part of the size
    const QSize change = size() - fittedSize_;
    const bool isMuch = some * qAbs(change.width()) > fittedSize_.width() ||
                        some * qAbs(change.height()) > fittedSize_.height();
    if (isFitting_ && (isMuch || !showsAll()))
        showAll();
    else if (isMuch && isUntouched_ && isFollowing_)
        showFirst();
}

void MapView::keyPressEvent(QKeyEvent *event) {
    switch (event->key()) {
    case Qt::Key_F:
        return setFollowing(!isFollowing_);
    case Qt::Key_0:
        return fit();
    case Qt::Key_Plus:
    case Qt::Key_Equal:
        return zoom(step);
    case Qt::Key_Minus:
        return zoom(1 / step);
    default:
        QWidget::keyPressEvent(event);
    }
}

} // namespace hermes::desktop
