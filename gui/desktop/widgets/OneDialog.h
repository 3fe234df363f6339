#pragma once

#include <QDialog>
#include <QPointer>

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
    void close() {
        if (open_)
            open_->close();
    }

private:
    QPointer<QDialog> open_;
};

} // namespace hermes::desktop
