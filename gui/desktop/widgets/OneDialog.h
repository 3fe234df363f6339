#pragma once

#include <QMessageBox>
#include <QPointer>
#include <QPushButton>
#include <functional>

namespace hermes::desktop {

/// Shows dialogs one at a time: the next takes the place of the one before. They are not modal, for STOP and
/// all else is to stay in reach, and are gone when they are closed or with their parent.
class OneDialog {
public:
    void show(QDialog *dialog) {
        close();
        open_ = dialog;
        dialog->setAttribute(Qt::WA_DeleteOnClose);
        dialog->setWindowModality(Qt::NonModal);
        dialog->show();
    }
    /// Asks whether something is really to be done.
    void ask(QWidget *parent, const QString &title, const QString &question, const QString &yes,
             const std::function<void()> &work) {
        auto *const box =
            new QMessageBox(QMessageBox::Question, title, question, QMessageBox::Cancel, parent);
        QPushButton *const accept = box->addButton(yes, QMessageBox::AcceptRole);
        accept->setObjectName("accept");
        box->setDefaultButton(QMessageBox::Cancel);
        QObject::connect(accept, &QPushButton::clicked, parent, work);
        show(box);
    }
    void close() {
        if (open_)
            open_->close();
    }

private:
    QPointer<QDialog> open_;
};

} // namespace hermes::desktop
