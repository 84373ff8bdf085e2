# SPDX-License-Identifier: BSD-3-Clause
"""usage: clean_root.py ROOT PACKAGE.deb: a root in which that package is installed with what it depends on, and nothing
else. The files of the dependencies are those of this machine; prints "no clean root: ..." where it lacks one."""

import pathlib
import re
import subprocess
import sys

DPKG = pathlib.Path("/var/lib/dpkg")


def stanzas():
    """{package: its fields and text} of what is installed here."""
    found = {}
    for text in (DPKG / "status").read_text(encoding="utf-8").split("\n\n"):
        fields = dict(re.findall(r"^([A-Za-z-]+): (.*)$", text, re.MULTILINE))
        if fields.get("Status") == "install ok installed":
            found.setdefault(fields["Package"], {**fields, "text": text})
    return found


def alternatives(depends):
    """[[name, ...]]: of each list one must be there."""
    return [[re.split(r"[\s(:]", choice.strip())[0] for choice in each.split("|")]
            for each in depends.split(",") if each.strip()]


def closure(depends, installed):
    """The names that the list of dependencies leads to; raises LookupError for one that is missing."""
    providers = {}
    for name, fields in installed.items():
        for (provided, *_) in alternatives(fields.get("Provides", "")):
            providers.setdefault(provided, name)
    found, waiting = set(), alternatives(depends)
    while waiting:
        choices = waiting.pop()
        name = next((n for n in choices if n in installed), None)
        name = name or next((providers[n] for n in choices if n in providers), None)
        if name is None:
            raise LookupError(" or ".join(choices))
        if name not in found:
            found.add(name)
            fields = installed[name]
            waiting += alternatives(fields.get("Depends", "")) + alternatives(fields.get("Pre-Depends", ""))
    return found


def fill(root, names, installed):
    """Copies the files of the packages, and the links of update-alternatives among them."""
    for folder in ("bin", "lib", "lib64", "sbin"):
        (root / "usr" / folder).mkdir(parents=True)
        (root / folder).symlink_to(f"usr/{folder}")
    info = root / "var/lib/dpkg/info"
    info.mkdir(parents=True)
    (root / "var/lib/dpkg/updates").mkdir()
    (root / "tmp").mkdir()
    files = set()
    for name in names:
        lists = [*(DPKG / "info").glob(f"{name}.list"), *(DPKG / "info").glob(f"{name}:*.list")]
        text = lists[0].read_text(encoding="utf-8")
        (info / lists[0].name).write_text(text, encoding="utf-8")
        files.update(text.split("\n"))
    folders = ("/usr/lib", "/usr/bin")
    links = subprocess.run(["find", *folders, "-lname", "/etc/alternatives/*"], check=False,  # unreadable folders
                           capture_output=True, text=True).stdout.split()
    for link in map(pathlib.Path, links):
        if str(link.resolve()) in files or str(link.resolve()).removeprefix("/usr") in files:
            files |= {str(link), str(link.readlink())}
    kept = [file[1:] for file in sorted(files) if file not in ("", "/.") and "/usr/share/" not in file]
    archive = subprocess.Popen(["tar", "-C", "/", "--no-recursion", "--ignore-failed-read", "-cf", "-", "-T", "-"],
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    unpack = subprocess.Popen(["tar", "-C", root, "--no-same-owner", "-xf", "-"], stdin=archive.stdout)
    archive.stdin.write("\n".join(kept).encode())
    archive.stdin.close()
    if unpack.wait() != 0:
        sys.exit("FAILED: the files of the dependencies cannot be copied")
    (root / "var/lib/dpkg/status").write_text(
        "\n\n".join(installed[name]["text"].strip("\n") for name in sorted(names)) + "\n\n", encoding="utf-8")


def main(root, package):
    """Fills the root and installs the package there."""
    installed = stanzas()
    depends = subprocess.run(["dpkg-deb", "-f", package, "Depends"], check=True, capture_output=True,
                             text=True).stdout
    try:
        names = closure(depends, installed)
    except LookupError as missing:
        print(f"no clean root: {missing} is not installed here")
        return
    fill(pathlib.Path(root), names, installed)
    subprocess.run(["ldconfig", "-r", root], check=True)
    subprocess.run(["dpkg", f"--root={root}", f"--log={root}/tmp/dpkg.log", "--force-script-chrootless", "-i", package], check=True,
                   stdout=subprocess.DEVNULL)
    print(f"clean root: {len(names)} dependencies of {pathlib.Path(package).name}")


if __name__ == "__main__":
    main(*sys.argv[1:])
