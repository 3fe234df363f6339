#include "gui/desktop/widgets/SaveDialog.h"

#include <QFileDialog>
#include <QMessageBox>
#include <QPushButton>
#include <QTimer>

namespace hermes::desktop {
namespace {

void askToReplace(OneDialog &questions, QWidget *parent, const QString &file,
                  const std::function<void()> &replace) {
    auto *const box =
        new QMessageBox(QMessageBox::Question, QFileDialog::tr("Replace"),
                        QFileDialog::tr("%1 exists. Replace it?").arg(file), QMessageBox::Cancel, parent);
    QPushButton *const accept = box->addButton(QFileDialog::tr("Replace"), QMessageBox::AcceptRole);
    accept->setObjectName("accept");
    box->setDefaultButton(QMessageBox::Cancel);
    QObject::connect(accept, &QPushButton::clicked, parent, replace);
    questions.show(box);
}

} // namespace

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
                askToReplace(questions, parent, file, [use, file] { use(file); });
            });
        });
    questions.show(dialog);
}

} // namespace hermes::desktop
