#include "gui/desktop/MessageWriter.h"

using namespace hermes::desktop;

/// A terminal that takes nothing any more holds nobody up.
class TestMessageWriter : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void aPipeThatNobodyReads() {
        int ends[2];
        QVERIFY(::pipe(ends) == 0);
        const int flags = ::fcntl(ends[1], F_GETFL);
        QVERIFY(::fcntl(ends[1], F_SETFL, flags | O_NONBLOCK) == 0);
        const QByteArray filling(4096, 'x');
        while (::write(ends[1], filling.constData(), std::size_t(filling.size())) > 0) {
        }
        QVERIFY(::fcntl(ends[1], F_SETFL, flags) == 0);
        const int real = ::dup(2);
        ::dup2(ends[1], 2);
        auto time = runningTimer();
        {
            const MessageWriter writer;
            for (int i = 0; i < 5000; ++i)
                qWarning("message %d", i);
        }
        const qint64 took_ms = time.elapsed();
        QByteArray read; // by a reader at last
        std::thread reader([&] {
            char bytes[4096];
            while (!read.contains("more messages are missing") || !read.contains("message 999\n"))
                if (const ssize_t count = ::read(ends[0], bytes, sizeof bytes); count > 0)
                    read.append(bytes, int(count));
                else
                    break;
        });
        reader.join();
        ::dup2(real, 2);
        QVERIFY2(took_ms < 1000 * slowness, saying(took_ms));
        QVERIFY(read.contains("message 0\n") && !read.contains("message 4000\n"));
    }
};
