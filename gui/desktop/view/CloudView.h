#pragma once

#include "gui/desktop/view/PointRenderer.h"

#include <QThread>
#include <QWidget>
#include <memory>

namespace hermes::desktop {

/// A cloud in perspective: the left button of the mouse turns it, the right or the middle one moves it, the
/// wheel zooms. Home, End, Page up and Page down turn it, + and - zoom, 0 shows all. Drawn by OpenGL where
/// that can be had.
class CloudView : public QWidget {
    Q_OBJECT
public:
    explicit CloudView(const CloudModel &model, QWidget *parent = nullptr);
    ~CloudView() override;

    CloudScene &scene() { return scene_; }
    /// Shows all of the cloud from behind the robot.
    void resetView();
    void colourBy(CloudScene::Colouring colouring);
    /// What draws the points; null before it was shown.
    const PointRenderer *renderer() const { return renderer_.get(); }
    void setRenderer(std::unique_ptr<PointRenderer> renderer);
    QSize sizeHint() const override { return {480, 240}; }

Q_SIGNALS:
    /// What draws the points is known now, or another.
    void rendererChanged();

protected:
    void showEvent(QShowEvent *event) override;
    void paintEvent(QPaintEvent *event) override;
    void changeEvent(QEvent *event) override;
    void wheelEvent(QWheelEvent *event) override;
    void mousePressEvent(QMouseEvent *event) override;
    void mouseMoveEvent(QMouseEvent *event) override;
    void keyPressEvent(QKeyEvent *event) override;

private:
    void drawPoints(QPainter &painter);
    void refresh();

    const CloudModel &model_;
    CloudScene scene_;
    std::unique_ptr<PointRenderer> renderer_;
    std::unique_ptr<QThread> loading_; // OpenGL
    bool wasFitted_ = false;
    QPointF last_; // of the mouse
};

} // namespace hermes::desktop
