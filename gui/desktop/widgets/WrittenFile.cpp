#include "gui/desktop/widgets/WrittenFile.h"

#include "common/files/SavedFile.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QFileInfo>
#include <QImage>
#include <QPainter>
#include <QPalette>
#include <QPointer>
#include <QSvgGenerator>
#include <QThreadPool>

namespace hermes::desktop {
namespace {

/// As a whole, or not at all.
Result<void> write(const QString &file, const std::function<bool(QIODevice &)> &content) {
    SavedFile out(file);
    if (const auto begun = out.begin(); !begun)
        return begun;
    if (!content(out))
        return Error(ErrorCode::InputOutput, QObject::tr("%1 cannot be written").arg(file));
    return out.commit();
}

QByteArray svgOf(const QString &title, const QSize &size, const std::function<void(QPainter &)> &draw) {
    QBuffer text;
    QSvgGenerator svg;
    svg.setOutputDevice(&text);
    svg.setSize(size);
    svg.setViewBox(QRect({0, 0}, size));
    svg.setTitle(title);
    QPainter painter(&svg);
    draw(painter);
    painter.end();
    return text.data();
}

} // namespace

Writing picture(const QString &file, const QString &title, const QSize &size,
                const std::function<void(QPainter &)> &draw) {
    if (file.endsWith(".svg", Qt::CaseInsensitive))
        return [file, text = svgOf(title, size, draw)] {
            return write(file, [&text](QIODevice &out) { return out.write(text) == text.size(); });
        };
    QImage image(size, QImage::Format_RGB32);
    image.fill(QPalette().color(QPalette::Window));
    QPainter painter(&image);
    draw(painter);
    painter.end();
    return [file, image] {
        const QByteArray format = QFileInfo(file).suffix().toLatin1();
        return write(file, [&](QIODevice &out) { return image.save(&out, format.constData()); });
    };
}

void writeBeside(const Writing &writing, QObject *receiver,
                 const std::function<void(const Result<void> &)> &tell) {
    QThreadPool::globalInstance()->start([writing, tell, told = QPointer<QObject>(receiver)] {
        const Result<void> done = writing();
        QMetaObject::invokeMethod(qApp, [=] {
            if (told)
                tell(done);
        });
    });
}

} // namespace hermes::desktop
