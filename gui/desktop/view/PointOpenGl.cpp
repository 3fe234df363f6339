#include "gui/desktop/view/PointOpenGl.h"

#include <QOpenGLFunctions>
#include <cstddef>

namespace hermes::desktop {
namespace {

constexpr int sizeFromShader = 0x8642; // GL_PROGRAM_POINT_SIZE; OpenGL ES has it always on

const char *const vertexShader = R"(
attribute highp vec3 place;
attribute lowp vec4 colour;
uniform highp mat4 matrix;
uniform mediump float pointSize;
varying lowp vec4 shade;
void main() {
    gl_Position = matrix * vec4(place, 1.0);
    gl_PointSize = pointSize;
    shade = colour;
}
)";
const char *const fragmentShader = R"(
varying lowp vec4 shade;
void main() {
    gl_FragColor = shade;
}
)";

const char *const setting = "HERMES_OPENGL";

bool isOff() {
    return qgetenv(setting) == "off";
}

/// Of Mesa, by the names that they give themselves.
bool isSimulated(const QByteArray &renderer) {
    for (const char *const name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer", "SWR"})
        if (renderer.contains(name))
            return true;
    return false;
}

} // namespace

std::unique_ptr<PointOpenGl> PointOpenGl::make() {
    if (isOff())
        return nullptr;
    std::unique_ptr<PointOpenGl> points(new PointOpenGl);
    return points->begin(qgetenv(setting) == "on") ? std::move(points) : nullptr;
}

std::unique_ptr<QThread> PointOpenGl::load() {
    if (isOff() || !QOpenGLContext::supportsThreadedOpenGL())
        return nullptr;
    return std::unique_ptr<QThread>(QThread::create([] { QOpenGLContext().create(); }));
}

PointOpenGl::~PointOpenGl() {
    if (!context_.isValid() || !context_.makeCurrent(&surface_))
        return;
    program_.reset();
    target_.reset();
    buffer_.destroy();
    context_.doneCurrent();
}

bool PointOpenGl::begin(bool maySimulate) {
    if (!context_.create())
        return false;
    surface_.setFormat(context_.format());
    surface_.create();
    if (!surface_.isValid() || !context_.makeCurrent(&surface_))
        return false;
    const auto *const name = reinterpret_cast<const char *>(context_.functions()->glGetString(GL_RENDERER));
    const bool isUsable = name && (maySimulate || !isSimulated(name)) &&
                          QOpenGLShaderProgram::hasOpenGLShaderPrograms(&context_) &&
                          QOpenGLFramebufferObject::hasOpenGLFramebufferObjects() && makeProgram();
    context_.doneCurrent();
    return isUsable;
}

bool PointOpenGl::makeProgram() {
    program_ = std::make_unique<QOpenGLShaderProgram>();
    program_->addShaderFromSourceCode(QOpenGLShader::Vertex, vertexShader);
    program_->addShaderFromSourceCode(QOpenGLShader::Fragment, fragmentShader);
    program_->bindAttributeLocation("place", 0);
    program_->bindAttributeLocation("colour", 1);
    buffer_.setUsagePattern(QOpenGLBuffer::StreamDraw);
    return program_->link() && buffer_.create();
}

const QImage *PointOpenGl::draw(const PointPicture &picture) {
    if (!context_.makeCurrent(&surface_))
        return nullptr;
    if (!target_ || target_->size() != picture.pixels) {
        target_ = std::make_unique<QOpenGLFramebufferObject>(picture.pixels, QOpenGLFramebufferObject::Depth);
        picture_ = QImage(picture.pixels, QImage::Format_RGBA8888_Premultiplied);
    }
    QOpenGLFunctions &gl = *context_.functions();
    gl.glGetError(); // forgets an older one
    const bool isBound = target_->isValid() && target_->bind();
    if (isBound)
        drawPoints(picture);
    gl.glReadPixels(0, 0, picture_.width(), picture_.height(), GL_RGBA, GL_UNSIGNED_BYTE, picture_.bits());
    const bool isDrawn = isBound && gl.glGetError() == GL_NO_ERROR && context_.isValid();
    context_.doneCurrent();
    return isDrawn ? &picture_ : nullptr;
}

void PointOpenGl::upload(const PointPicture &picture) {
    if (uploaded_ == picture.revision)
        return;
    uploaded_ = picture.revision;
    const int count = int(picture.points.size()), bytes = count * int(sizeof(CloudVertex));
    if (count > capacity_) {
        capacity_ = count;
        buffer_.allocate(picture.points.data(), bytes);
    } else if (count > 0) {
        buffer_.write(0, picture.points.data(), bytes);
    }
}

void PointOpenGl::drawPoints(const PointPicture &picture) {
    QOpenGLFunctions &gl = *context_.functions();
    buffer_.bind();
    upload(picture);
    gl.glViewport(0, 0, picture.pixels.width(), picture.pixels.height());
    gl.glClearColor(0, 0, 0, 0);
    gl.glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl.glEnable(GL_DEPTH_TEST);
    if (!context_.isOpenGLES())
        gl.glEnable(sizeFromShader);
    QMatrix4x4 upsideDown; // the rows of a picture begin at its top
    upsideDown.scale(1, -1);
    program_->bind();
    program_->setUniformValue("matrix", upsideDown * picture.matrix);
    program_->setUniformValue("pointSize", GLfloat(picture.pointSize));
    program_->setAttributeBuffer(0, GL_FLOAT, offsetof(CloudVertex, x), 3, sizeof(CloudVertex));
    program_->setAttributeBuffer(1, GL_UNSIGNED_BYTE, offsetof(CloudVertex, colour), 4, sizeof(CloudVertex));
    for (const int attribute : {0, 1})
        program_->enableAttributeArray(attribute);
    gl.glDrawArrays(GL_POINTS, 0, GLsizei(picture.points.size()));
    for (const int attribute : {0, 1})
        program_->disableAttributeArray(attribute);
    program_->release();
    buffer_.release();
}

} // namespace hermes::desktop
