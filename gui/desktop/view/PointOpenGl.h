#pragma once

#include "gui/desktop/view/PointRenderer.h"

#include <QOffscreenSurface>
#include <QOpenGLBuffer>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QOpenGLShaderProgram>
#include <QThread>
#include <memory>

namespace hermes::desktop {

/// Draws points by OpenGL 2 or OpenGL ES 2, apart from the window: Qt would else draw all of the window by
/// OpenGL from then on, STOP too, and a driver that fails would leave it as it was. The points lie in one
/// buffer, which is written when they change.
class PointOpenGl : public PointRenderer {
public:
    /// Null where OpenGL cannot be had, or only by a program that imitates a graphics processor: then
    /// PointRaster is faster. $HERMES_OPENGL: "off": never; "on": also by such a program.
    static std::unique_ptr<PointOpenGl> make();
    /// A thread, to be started, that loads the driver, for that takes longer than the window may be busy:
    /// afterwards make() is fast. Null: OpenGL is switched off, or does not work in threads.
    static std::unique_ptr<QThread> load();
    ~PointOpenGl() override;

    const QImage *draw(const PointPicture &picture) override;
    bool isByOpenGl() const override { return true; }

private:
    PointOpenGl() = default;
    bool begin(bool maySimulate);
    bool makeProgram();
    void upload(const PointPicture &picture);
    void drawPoints(const PointPicture &picture);

    QOffscreenSurface surface_;
    QOpenGLContext context_;
    std::unique_ptr<QOpenGLShaderProgram> program_;
    std::unique_ptr<QOpenGLFramebufferObject> target_;
    QOpenGLBuffer buffer_;
    QImage picture_;
    int capacity_ = 0; // of the buffer, in points
    quint64 uploaded_ = 0;
};

} // namespace hermes::desktop
