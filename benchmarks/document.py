"""What the scripts here share that write measurements into the documentation."""
import os
import platform
import subprocess
import sys


def machine():
    def version(package):
        done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True)
        return done.stdout or "unknown"
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
                 platform.processor())
    return (f"{os.cpu_count()} processors ({model}), MeshLab {version('meshlab')}, CGAL {version('libcgal-dev')}, "
            f"g++ {version('g++').split(':')[-1]}.\n")


def insert(document, parts):
    """Replaces what stands between the marks <!-- part --> and <!-- end of part --> of a document."""
    text = document.read_text()
    for part, content in parts.items():
        begin, end = f"<!-- {part} -->\n", f"<!-- end of {part} -->"
        if begin not in text or end not in text:
            sys.exit(f"{document} has no marks for the {part}")
        head, rest = text.split(begin, 1)
        text = head + begin + "\n" + content + "\n" + end + rest.split(end, 1)[1]
    document.write_text(text)
