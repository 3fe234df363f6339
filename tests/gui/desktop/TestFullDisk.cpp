#include "common/files/SavedFile.h"
#include "gui/desktop/model/CurveTable.h"
#include "gui/desktop/widgets/WrittenFile.h"

using namespace hermes;
using namespace hermes::desktop;

using Write = std::function<Result<void>(const QString &)>;
Q_DECLARE_METATYPE(Write)

/// What the window writes where there is no room for it: an error that names the file, and the file before
/// stays.
class TestFullDisk : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void isToldAndChangesNothing_data() {
        const Rows<QString, Write> row("name", "write");
        row("bytes", "a.json", [](const QString &file) { return saveFile(file, QByteArray(100000, 'x')); });
        row("few bytes", "a.txt",
            [](const QString &file) { return saveFile(file, QByteArray(room_bytes + 1, 'x')); });
        row("curves", "a.csv", [](const QString &file) {
            KeptCurve curve;
            for (int i = 0; i < 10000; ++i)
                curve.samples.emplace_back(0.1 * i, 0.3 * i);
            return writeCurves(file, {curve});
        });
        for (const char *name : {"a.svg", "a.png"})
            row(name, name, [](const QString &file) {
                return picture(file, "noise", {300, 300}, [](QPainter &painter) {
                    for (int i = 0; i < 3000; ++i)
                        painter.fillRect(i * 7 % 300, i * 11 % 300, 5, 5,
                                         QColor::fromRgb(QRgb(i) * 2654435761U));
                })();
            });
    }
    void isToldAndChangesNothing() {
        FETCH(QString, name, Write, write);
        const QTemporaryDir folder;
        const QString path = folder.filePath(name);
        QVERIFY(write(path).ok());
        QVERIFY(QFileInfo(path).size() > room_bytes);
        put(path, "before");
        rlimit before{};
        QCOMPARE(::getrlimit(RLIMIT_FSIZE, &before), 0);
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit little{room_bytes, before.rlim_max};
        QCOMPARE(::setrlimit(RLIMIT_FSIZE, &little), 0);
        const Result<void> done = write(path);
        ::setrlimit(RLIMIT_FSIZE, &before);
        QVERIFY(!done.ok());
        VERIFY_CONTAINS(done.error().message, path);
        QCOMPARE(contentOf(path), QByteArray("before"));
        QCOMPARE(QDir(folder.path()).entryList(QDir::Files), QStringList(name));
    }

private:
    static constexpr int room_bytes = 1000;
};
