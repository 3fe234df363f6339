// Files of keys where the system fails: a full disk, names that it cannot look up, folders that cannot be
// renamed.
#include "common/tls/Authority.h"
#include "common/tls/FolderPlace.h"
#include "common/tls/KeyFolder.h"

#include <climits>

using namespace hermes;

class TestKeyFiles : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void aFullDiskLeavesNoHalfLine() {
        QTemporaryDir folder;
        const Authority authority(folder.filePath("keys"));
        QVERIFY(authority.init("owner", 10, 10));
        const auto made = authority.issue({"anna", "observer"}, 10);
        QVERIFY2(made, made ? "" : qPrintable(made.error().message));
        const QString list = folder.filePath("keys/revoked");
        put(list, "# " + QByteArray(998, 'x') + '\n');
        const QByteArray before = contentOf(list);
        {
            const FileSizeLimit limit(rlim_t(before.size() + 10));
            const auto revoked = authority.revoke("anna");
            QVERIFY(!revoked);
            VERIFY_CONTAINS(revoked.error().message, "File too large");
        }
        QCOMPARE(contentOf(list), before);
        QVERIFY(authority.revoke("anna"));
        QCOMPARE(KeyFolder::revoked(folder.filePath("keys"))->size(), 1);
    }

    void aFullDiskTakesNoKey() {
        QTemporaryDir folder;
        const Authority authority(folder.filePath("keys"));
        QVERIFY(authority.init("owner", 10, 10));
        const QByteArray before = contentOf(folder.filePath("keys/own.key"));
        {
            const FileSizeLimit limit(rlim_t(100));
            QVERIFY(!writeKeyFile(folder.filePath("keys/own.key"), QByteArray(200, 'k')));
        }
        QCOMPARE(contentOf(folder.filePath("keys/own.key")), before);
    }

    void onlyAnAbsentListIsNone() {
        QTemporaryDir folder;
        const auto none = KeyFolder::revoked(folder.path());
        QVERIFY(none && none->isEmpty());
        // The folder can be entered; the name of a file in it is longer than the system looks up.
        QString name = folder.path();
        while (name.size() + 2 < PATH_MAX - 4)
            name += "/.";
        QVERIFY(QDir(name).exists());
        const auto untold = KeyFolder::revoked(name);
        QVERIFY(!untold);
        VERIFY_CONTAINS(untold.error().message, "File name too long");
    }

    void aFolderTakesThePlaceOfAnEmptyOne() {
        QTemporaryDir folder;
        const QDir dir(folder.path());
        QVERIFY(dir.mkpath("new/inside") && dir.mkpath("empty") && dir.mkpath("full/inside"));
        QVERIFY(!takePlace(dir.filePath("new"), dir.filePath("full")));
        QVERIFY(dir.exists("new/inside") && dir.exists("full/inside"));
        QVERIFY(takePlace(dir.filePath("new"), dir.filePath("empty")));
        QVERIFY(dir.exists("empty/inside") && !dir.exists("new"));
    }

    void anEmptyFolderStaysWhereNothingTakesItsPlace() {
        QTemporaryDir folder;
        const QDir dir(folder.path());
        QVERIFY(dir.mkpath("empty"));
        QVERIFY(!takePlace(dir.filePath("absent"), dir.filePath("empty")));
        QVERIFY(dir.exists("empty"));
    }
};
