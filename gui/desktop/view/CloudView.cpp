#include "gui/desktop/view/CloudView.h"

#include "gui/desktop/view/PointOpenGl.h"
#include "gui/desktop/view/PointRaster.h"

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <cmath>

namespace hermes::desktop {

CloudView::CloudView(const CloudModel &model, QWidget *parent)
    : QWidget(parent)
    , model_(model)
    , scene_(model) {
    setFocusPolicy(Qt::StrongFocus);
    setAttribute(Qt::WA_OpaquePaintEvent);
    setMinimumSize(200, 80);
    connect(&model, &CloudModel::changed, this, &CloudView::refresh);
}

CloudView::~CloudView() {
    constexpr unsigned long longest_ms = 5000;
    if (loading_ && !loading_->wait(longest_ms))
        loading_.release(); // its driver hangs: the window does not
}

// OpenGL is not asked for before somebody looks.
void CloudView::showEvent(QShowEvent *) {
    scene_.update();
    if (renderer_)
        return;
    setRenderer(std::make_unique<PointRaster>());
    loading_ = PointOpenGl::load();
    if (!loading_)
        return;
    connect(loading_.get(), &QThread::finished, this, [this, first = renderer_.get()] {
        if (renderer_.get() != first)
            return;
        if (auto byOpenGl = PointOpenGl::make())
            setRenderer(std::move(byOpenGl));
    });
    loading_->start();
}

void CloudView::setRenderer(std::unique_ptr<PointRenderer> renderer) {
    renderer_ = std::move(renderer);
    update();
    Q_EMIT rendererChanged();
}

void CloudView::paintEvent(QPaintEvent *) {
    QPainter painter(this);
    scene_.paintGround(painter, size());
    drawPoints(painter);
    scene_.paintWords(painter, size());
}

void CloudView::drawPoints(QPainter &painter) {
    constexpr double pointSize = 2;
    const PointPicture wanted{scene_.vertices(), scene_.revision(), scene_.camera.matrix(size()),
                              size() * devicePixelRatioF(), qRound(pointSize * devicePixelRatioF())};
    const QImage *picture = renderer_->draw(wanted);
    if (!picture) { // OpenGL has failed
        setRenderer(std::make_unique<PointRaster>());
        picture = renderer_->draw(wanted);
    }
    painter.drawImage(rect(), *picture);
}

void CloudView::refresh() {
    if (model_.age().state() == Freshness::State::None)
        wasFitted_ = false; // another lidar
    else if (!wasFitted_ && !model_.points().empty())
        resetView();
    if (!isVisible())
        return;
    scene_.update();
    update();
}

void CloudView::resetView() {
    wasFitted_ = !model_.points().empty();
    scene_.camera.reset(double(model_.reach_m()));
    update();
}

void CloudView::colourBy(CloudScene::Colouring colouring) {
    scene_.colouring = colouring;
    scene_.update();
    update();
}

void CloudView::changeEvent(QEvent *event) {
    if (event->type() == QEvent::PaletteChange) {
        scene_.update();
        update();
    }
    QWidget::changeEvent(event);
}

void CloudView::wheelEvent(QWheelEvent *event) {
    scene_.camera.zoom(std::pow(1.2, event->angleDelta().y() / 120.0));
    update();
    event->accept();
}

void CloudView::mousePressEvent(QMouseEvent *event) {
    last_ = event->localPos();
}

void CloudView::mouseMoveEvent(QMouseEvent *event) {
    const QPointF way = event->localPos() - last_;
    last_ = event->localPos();
    if (event->buttons() & Qt::LeftButton) {
        constexpr double degreesAPixel = 0.4;
        scene_.camera.orbit(-degreesAPixel * way.x(), degreesAPixel * way.y());
    } else if (event->buttons() & (Qt::RightButton | Qt::MiddleButton)) {
        scene_.camera.pan(QPointF(way.x(), -way.y()) / qMax(1, height()));
    } else {
        return;
    }
    update();
}

void CloudView::keyPressEvent(QKeyEvent *event) {
    constexpr double step_deg = 10, step = 1.2;
    static const QMap<int, QPointF> turns{{Qt::Key_Home, {-step_deg, 0}},
                                          {Qt::Key_End, {step_deg, 0}},
                                          {Qt::Key_PageUp, {0, step_deg}},
                                          {Qt::Key_PageDown, {0, -step_deg}}};
    static const QMap<int, double> zooms{
        {Qt::Key_Plus, step}, {Qt::Key_Equal, step}, {Qt::Key_Minus, 1 / step}};
    const int key = event->key();
    if (key == Qt::Key_0)
        return resetView();
    if (!turns.contains(key) && !zooms.contains(key))
        return QWidget::keyPressEvent(event);
    const QPointF turn = turns.value(key);
    scene_.camera.orbit(turn.x(), turn.y());
    scene_.camera.zoom(zooms.value(key, 1));
    update();
}

} // namespace hermes::desktop
