#include "gui/desktop/widgets/SaveDialog.h"

#include <QFileDialog>
#include <QTimer>

namespace hermes::desktop {

void askForFile(OneDialog &questions, QWidget *parent, const QString &title, const QString &name,
                const QString &kinds, const std::function<void(const QString &file)> &use) {
    auto *const dialog = new QFileDialog(parent, title, name, kinds);
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    dialog->setOption(QFileDialog::DontUseNativeDialog); // whose keys this program does not see
    // Its own questions are modal: STOP would be out of reach.
    dialog->setOption(QFileDialog::DontConfirmOverwrite);
    dialog->setOption(QFileDialog::ReadOnly);
    QObject::connect(
        dialog, &QFileDialog::fileSelected, parent, [&questions, parent, use](const QString &file) {
            if (!QFileInfo::exists(file))
                return use(file);
            QTimer::singleShot(0, parent, [&questions, parent, use, file] { // when the dialog has gone
                questions.ask(parent, QFileDialog::tr("Replace"),
                              QFileDialog::tr("%1 exists. Replace it?").arg(file), QFileDialog::tr("Replace"),
                              [use, file] { use(file); });
            });
        });
    questions.show(dialog);
}

} // namespace hermes::desktop
