#include "common/files/NamedFile.h"

using namespace hermes;

/// A folder for clients beside one that is not, with all that can stand in the way. Whatever a client names:
/// only what is below its folder is read, only regular files there are written, and it takes no time.
class TestNamedFile : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        root_ = std::make_unique<QTemporaryDir>();
        for (const char *folder : {"allowed", "allowed/sub", "other"})
            QVERIFY(QDir(root_->path()).mkpath(folder));
        put("allowed/map", "a map");
        put("allowed/sub/map", "another map");
        put("other/secret", "a secret");
        put("allowed/empty", {});
        link("map", "allowed/inside");
        link("../other/secret", "allowed/outside");
        link("../other", "allowed/way-out");
        link("nothing", "allowed/dangling");
        link("sub", "allowed/to-sub");
        link("/dev/zero", "allowed/zero");
        QCOMPARE(::mkfifo(QFile::encodeName(at("allowed/pipe")).constData(), 0600), 0);
    }

    void reads_data() {
        const Rows<QString, QByteArray> row("name", "bytes");
        row("file", "allowed/map", "a map");
        row("link within", "allowed/inside", "a map");
        row("linked folder within", "allowed/to-sub/map", "another map");
        row("there and back", "allowed/../other/../allowed//./map", "a map");
    }

    void reads() {
        FETCH(QString, name, QByteArray, bytes);
        const auto read = readNamedFile(at(name), folders(), 100);
        QVERIFY2(read, read ? "" : qPrintable(read.error().message));
        QCOMPARE(*read, bytes);
        QVERIFY(findNamedFile(at(name), folders()));
        const auto tooLarge = readNamedFile(at(name), folders(), 4);
        QVERIFY(!tooLarge && tooLarge.error().message.contains("expected 1 to 4"));
    }

    void refusesToRead_data() {
        const Rows<QString, QString> row("path", "why");
        row("beside", "other/secret", "not below");
        row("above", "allowed/../other/secret", "not below");
        row("link out", "allowed/outside", "secret, not below");
        row("linked folder out", "allowed/way-out/secret", "not below");
        row("dangling", "allowed/dangling", "No such file");
        row("missing", "allowed/none", "No such file");
        row("empty", "allowed/empty", "0 bytes");
        row("folder", "allowed/sub", "not a regular file");
        row("itself", "allowed", "not below");
        row("pipe", "allowed/pipe", "not a regular file");
        row("link to a device", "allowed/zero", "not below");
        row("device", "/dev/zero", "not below");
        row("messages of the kernel", "/proc/kmsg", "not below");
        row("NUL", QString("allowed/pipe") + QChar(0) + ".csv", "control characters");
        row("line feed", "allowed/map\n", "control characters");
        row("file as a folder", "allowed/map/x", "Not a directory");
        row("long", "allowed/" + QString(5000, 'x'), "of less than 4096 bytes");
        row("long name", "allowed/" + QString(300, 'x'), "name too long");
    }

    void refusesToRead() {
        FETCH(QString, path, QString, why);
        const QString full = path.startsWith('/') ? path : at(path);
        auto time = runningTimer();
        const auto read = readNamedFile(full, folders(), 100);
        QVERIFY(!read);
        QVERIFY(time.elapsed() < 1000);
        QVERIFY(read.error().is(ErrorCode::InputOutput));
        QVERIFY2(read.error().message.contains(why, Qt::CaseInsensitive), qPrintable(read.error().message));
        QVERIFY(!read.error().data["path"].toString().isEmpty());
        if (!path.endsWith("empty"))
            QVERIFY(!findNamedFile(full, folders()));
        // Where all folders are allowed, too, nothing but regular files with an end.
        if (path.startsWith("/dev") || path.startsWith("/proc") || path.endsWith("pipe") ||
            path.endsWith("zero"))
            QVERIFY(!readNamedFile(full, {"/"}, 1 << 20));
    }

    void refusesToWrite_data() {
        const Rows<QString> row("path");
        for (const char *path : {"other/new",
                                 "allowed/../other/new",
                                 "allowed/way-out/new",
                                 "allowed/outside",
                                 "allowed/inside",
                                 "allowed/dangling",
                                 "allowed/pipe",
                                 "allowed/zero",
                                 "allowed/sub",
                                 "allowed/none/new",
                                 "allowed",
                                 "/dev/null",
                                 "/proc/self/fd/2",
                                 "/proc/self/cwd/new",
                                 "allowed/.",
                                 "allowed/sub/..",
                                 "allowed/new/",
                                 "allowed/new/.",
                                 "allowed/way-out/../new",
                                 "allowed/map/new",
                                 "allowed/new\n",
                                 ""})
            row(path, QString(path));
        row("NUL", QString("allowed/new") + QChar(0) + "x");
        row("long name", "allowed/" + QString(300, 'x'));
    }

    void refusesToWrite() {
        QFETCH(QString, path);
        const QByteArray before = outside();
        for (const bool replace : {false, true}) {
            const auto written =
                writeNamedFile(path.startsWith('/') ? path : at(path), folders(), "new", replace);
            QVERIFY(!written);
            QVERIFY2(written.error().is(ErrorCode::InputOutput), qPrintable(written.error().message));
        }
        QCOMPARE(outside(), before);
        QCOMPARE(content("allowed/map"), QByteArray("a map"));
        QVERIFY(QDir(at("allowed")).entryList({".hermes*"}, QDir::AllEntries | QDir::Hidden).isEmpty());
    }

    void replacesOnlyWhenTold() {
        QVERIFY(writeNamedFile(at("allowed/new"), folders(), "new", false));
        QCOMPARE(content("allowed/new"), QByteArray("new"));
        const auto again = writeNamedFile(at("allowed/new"), folders(), "newer", false);
        QVERIFY(!again && again.error().message.contains("exists already"));
        QCOMPARE(content("allowed/new"), QByteArray("new"));
        QVERIFY(writeNamedFile(at("allowed/to-sub/map"), folders(), "newer", true));
        QCOMPARE(content("allowed/sub/map"), QByteArray("newer"));
    }

    void linkedFolderIsAFolder() {
        link("allowed", "by-another-name");
        QVERIFY(readNamedFile(at("allowed/map"), {at("by-another-name")}, 100));
        QVERIFY(readNamedFile(at("by-another-name/map"), folders(), 100));
        QVERIFY(writeNamedFile(at("by-another-name/new"), folders(), "new", false));
        // A folder that is missing allows nothing.
        QVERIFY(!readNamedFile(at("allowed/map"), {at("missing")}, 100));
        QVERIFY(!readNamedFile(at("allowed/map"), {}, 100));
    }

    void whateverIsNamed() {
        const std::vector<QString> steps{
            "allowed", "other",  "sub",      "map",  "secret", "outside", "way-out", "..", ".",    "",
            "to-sub",  "inside", "dangling", "pipe", "zero",   "new",     "empty",   "~",  "a\\b", "\u00e4"};
        std::mt19937 random(newSeed());
        const QByteArray before = outside();
        for (int i = 0; i < 3000; ++i) {
            QString name = "allowed";
            for (auto left = random() % 5; left > 0; --left)
                name += '/' + steps[random() % steps.size()];
            auto time = runningTimer();
            if (const auto read = readNamedFile(at(name), folders(), 100))
                QVERIFY2(!read->contains("secret"), qPrintable(name));
            writeNamedFile(at(name), folders(), "written", random() % 2 == 0);
            QVERIFY2(time.elapsed() < 1000, qPrintable(name));
            QVERIFY2(outside() == before, qPrintable(name));
        }
    }

    // Whoever names a file may sit in another folder than the program that reads it.
    void tellsWhereARelativePathBegins() {
        const QString before = QDir::currentPath(), here = QFileInfo(at("allowed")).canonicalFilePath();
        QVERIFY(QDir::setCurrent(here));
        const auto read = readNamedFile("sub/map", folders(), 100);
        const auto missing = readNamedFile("sub/none", folders(), 100);
        const auto unwritten = writeNamedFile("none/map", folders(), "new", false);
        QVERIFY(QDir::setCurrent(before));
        QVERIFY(read);
        for (const auto &[error, path] : {std::pair{missing.error(), QString("sub/none")},
                                          std::pair{unwritten.error(), QString("none/map")}}) {
            QCOMPARE(error.data["path"].toString(), here + '/' + path);
            VERIFY_STARTS(error.message, here + '/' + path + ": cannot be ");
            QVERIFY2(error.message.endsWith(
                         QString("(\"%1\" was looked for in %2, where this program runs)").arg(path, here)),
                     qPrintable(error.message));
        }
    }

private:
    QString at(const QString &name) const { return root_->filePath(name); }
    QStringList folders() const { return {at("allowed")}; }
    void put(const QString &name, const QByteArray &bytes) const { ::put(at(name), bytes); }
    QByteArray content(const QString &name) const { return contentOf(at(name)); }
    void link(const QByteArray &target, const QString &name) const {
        QCOMPARE(::symlink(target.constData(), QFile::encodeName(at(name)).constData()), 0);
    }

    // All that is not for clients, and the kinds of all that is.
    QByteArray outside() const {
        QByteArray all;
        for (const char *name : {"other/secret", "allowed/way-out/secret"})
            all += content(name) + '\n';
        for (const char *name :
             {"pipe", "inside", "outside", "way-out", "dangling", "to-sub", "zero", "sub"}) {
            struct stat status {};
            if (::lstat(QFile::encodeName(at(QString("allowed/") + name)).constData(), &status) == 0)
                all += QByteArray::number(status.st_mode & S_IFMT) + ' ';
        }
        all += QDir(at("other"))
                   .entryList(QDir::AllEntries | QDir::Hidden | QDir::NoDotAndDotDot)
                   .join('/')
                   .toUtf8();
        return all + QDir(root_->path())
                         .entryList(QDir::AllEntries | QDir::Hidden | QDir::NoDotAndDotDot)
                         .join('/')
                         .toUtf8();
    }

    std::unique_ptr<QTemporaryDir> root_;
};
