#include "common/files/NamedFile.h"
#include "tests/fuzz/FuzzInput.h"

#include <QDir>
#include <QTemporaryDir>

#include <sys/stat.h>
#include <unistd.h>

using namespace hermes;

namespace {

void put(const QString &path, const QByteArray &bytes) {
    QFile file(path);
    FUZZ_REQUIRE(file.open(QIODevice::WriteOnly) && file.write(bytes) == bytes.size());
}

/// A folder for clients beside one that is not, with links, a pipe and a folder in it.
class Tree {
public:
    Tree() {
        QDir(root_.path()).mkpath("allowed/sub");
        QDir(root_.path()).mkpath("other");
        put(at("allowed/map"), "a map");
        put(at("other/secret"), "a secret");
        for (const auto &[target, name] : {std::pair("map", "in"),
                                           {"../other/secret", "out"},
                                           {"../other", "o"},
                                           {"nothing", "none"},
                                           {"sub", "s"},
                                           {"/dev/zero", "zero"},
                                           {"loop", "loop"}})
            FUZZ_REQUIRE(::symlink(target, qPrintable(at(QString("allowed/") + name))) == 0);
        FUZZ_REQUIRE(::mkfifo(qPrintable(at("allowed/pipe")), 0600) == 0);
        before_ = state();
    }
    QString at(const QString &name) const { return root_.filePath(name); }
    bool isIntact() const { return state() == before_; }

private:
    // All that no client may change.
    QByteArray state() const {
        QFile secret(at("other/secret"));
        QByteArray all = secret.open(QIODevice::ReadOnly) ? secret.readAll() : QByteArray("gone");
        for (const char *name : {"in", "out", "o", "none", "s", "zero", "loop", "pipe", "sub"}) {
            struct stat status {};
            ::lstat(qPrintable(at(QString("allowed/") + name)), &status);
            all += QByteArray::number(status.st_mode & S_IFMT) + ' ';
        }
        const auto everything = QDir::AllEntries | QDir::Hidden | QDir::System | QDir::NoDotAndDotDot;
        return all + QDir(at("other")).entryList(everything).join('/').toUtf8() +
               QDir(root_.path()).entryList(everything).join('/').toUtf8();
    }

    QTemporaryDir root_;
    QByteArray before_;
};

} // namespace

/// Whatever is named: nothing outside of the allowed folder is read or written, and no link, pipe or folder
/// in it is replaced.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    static const Tree tree;
    FuzzInput in(data, size);
    const bool isAbsolute = in.take<std::uint8_t>() % 8 == 0, replace = in.take<std::uint8_t>() % 2;
    const std::string bytes = in.bytes(size);
    const QString name = QString::fromUtf8(bytes.data(), int(bytes.size())); // zeros, too
    const QString path = isAbsolute ? name : tree.at("allowed") + '/' + name;
    const QStringList folders{tree.at("allowed")};
    if (const auto read = readNamedFile(path, folders, 1000))
        FUZZ_REQUIRE(!read->contains("secret"));
    if (const auto found = findNamedFile(path, folders))
        FUZZ_REQUIRE(found->startsWith(tree.at("allowed")));
    const auto written = writeNamedFile(path, folders, "written", replace);
    FUZZ_REQUIRE(tree.isIntact());
    if (written) {
        const auto back = readNamedFile(path, folders, 1000);
        FUZZ_REQUIRE(back && *back == "written");
        if (!path.endsWith("map"))
            QFile::remove(*findNamedFile(path, folders));
    }
    return 0;
}
