#include "common/Mailbox.h"

#include <poll.h>

using namespace hermes;

static bool isReadable(int descriptor, int milliseconds = 0) {
    pollfd waited{descriptor, POLLIN, 0};
    return ::poll(&waited, 1, milliseconds) == 1;
}

class TestMailbox : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void keepsTheOrder() {
        Mailbox<int> mail(3);
        QVERIFY(mail.take().empty());
        for (int i : {1, 2, 3})
            QVERIFY(mail.post(i));
        QCOMPARE(mail.take(), (std::vector<int>{1, 2, 3}));
        QVERIFY(mail.post(4));
        QCOMPARE(mail.take(), std::vector<int>{4});
        QVERIFY(mail.take().empty());
    }

    void refusesWhatIsTooMuch() {
        Mailbox<std::unique_ptr<int>> mail(1);
        QVERIFY(mail.post(std::make_unique<int>(1)));
        auto second = std::make_unique<int>(2);
        QVERIFY(!mail.post(std::move(second)));
        QCOMPARE(*second, 2); // still here
        QCOMPARE(mail.take().size(), std::size_t(1));
        QVERIFY(mail.post(std::move(second)));
    }

    void tellsThatThereIsSomething() {
        Mailbox<int> mail(2);
        QVERIFY(!isReadable(mail.descriptor()));
        mail.post(1);
        mail.post(2);
        QVERIFY(isReadable(mail.descriptor()));
        mail.take();
        QVERIFY(!isReadable(mail.descriptor()));
    }

    void losesNothingBetweenThreads() {
        constexpr int count = 100000;
        Mailbox<int> mail(16);
        std::thread sender([&mail] {
            for (int i = 0; i < count; ++i) {
                while (!mail.post(i))
                    std::this_thread::yield();
            }
        });
        int next = 0;
        bool inOrder = true;
        while (next < count && inOrder && isReadable(mail.descriptor(), 5000)) {
            for (int value : mail.take())
                inOrder = inOrder && value == next++;
        }
        sender.join();
        QVERIFY(inOrder);
        QCOMPARE(next, count);
    }
};
