"""Reads, writes and judges small meshes, with nothing but Python: tests must not trust the code that they test."""
import math
import struct
from collections import Counter

FORMATS = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h", "ushort": "H",
           "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I", "float": "f", "float32": "f",
           "double": "d", "float64": "d"}


class Ply:
    """A binary PLY file: every vertex and face as its bytes, and the coordinates and corners."""

    def __init__(self, path):
        data = path.read_bytes()
        end = data.index(b"end_header\n") + len(b"end_header\n")
        header = data[:end].decode("latin-1").splitlines()
        if "format binary_little_endian 1.0" not in header:
            raise ValueError(f"{path} is not a little-endian binary PLY file")
        elements = []
        for words in (line.split() for line in header):
            if words[0] == "element":
                elements.append((words[1], int(words[2]), []))
            elif words[0] == "property":
                elements[-1][2].append(words[1:])
        self.properties = {name: properties for name, _, properties in elements}
        self.records = {}
        self.positions, self.faces = [], []
        offset = end
        for name, count, properties in elements:
            records = []
            for _ in range(count):
                start = offset
                values, offset = read_record(data, offset, properties)
                records.append(data[start:offset])
                if name == "vertex":
                    self.positions.append((values["x"], values["y"], values["z"]))
                elif name == "face":
                    self.faces.append(tuple(values.get("vertex_indices") or values.get("vertex_index")))
            self.records[name] = records
        if offset != len(data):
            raise ValueError(f"{path} has {len(data) - offset} bytes too many")


def read_record(data, offset, properties):
    values = {}
    for prop in properties:
        if prop[0] == "list":
            (count,) = struct.unpack_from("<" + FORMATS[prop[1]], data, offset)
            offset += struct.calcsize("<" + FORMATS[prop[1]])
            pattern = f"<{count}{FORMATS[prop[2]]}"
            values[prop[3]] = struct.unpack_from(pattern, data, offset)
        else:
            pattern = "<" + FORMATS[prop[0]]
            (values[prop[1]],) = struct.unpack_from(pattern, data, offset)
        offset += struct.calcsize(pattern)
    return values, offset


def difference(before, after):
    """What of `before` is not, bit for bit and in the same place, in `after`; None when nothing is missing."""
    for element in ("vertex", "face"):
        if before.properties[element] != after.properties[element]:
            return f"the {element} properties differ: {before.properties[element]}, {after.properties[element]}"
        old, new = before.records[element], after.records[element]
        if len(new) < len(old):
            return f"{len(old) - len(new)} of {len(old)} {element} records are gone"
        for number, (a, b) in enumerate(zip(old, new)):
            if a != b:
                return f"{element} {number} differs: {a.hex()} became {b.hex()}"
    return None


def write_ply(path, vertices, faces, vertex_extra=(), face_extra=(), extra_vertex_values=None, extra_face_values=None):
    """Writes a binary PLY file. `*_extra` are (type, name) pairs; the values are one tuple per element."""
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"property {kind} {name}" for kind, name in vertex_extra]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
    lines += [f"property {kind} {name}" for kind, name in face_extra]
    parts = ["\n".join(lines + ["end_header\n"]).encode()]
    vertex_format = "<3f" + "".join(FORMATS[kind] for kind, _ in vertex_extra)
    for number, vertex in enumerate(vertices):
        parts.append(struct.pack(vertex_format, *vertex, *(extra_vertex_values[number] if vertex_extra else ())))
    face_format = "".join(FORMATS[kind] for kind, _ in face_extra)
    for number, face in enumerate(faces):
        parts.append(struct.pack(f"<B{len(face)}i" + face_format, len(face), *face,
                                 *(extra_face_values[number] if face_extra else ())))
    path.write_bytes(b"".join(parts))


def edge_counts(faces):
    """How many faces each undirected edge has, and how often each directed edge is walked."""
    undirected, directed = Counter(), Counter()
    for face in faces:
        for a, b in zip(face, face[1:] + face[:1]):
            undirected[min(a, b), max(a, b)] += 1
            directed[a, b] += 1
    return undirected, directed


def boundary_edges(faces):
    return sum(1 for count in edge_counts(faces)[0].values() if count == 1)


def is_closed_manifold(faces):
    """Every edge has two faces that walk it in opposite directions."""
    undirected, directed = edge_counts(faces)
    return all(count == 2 for count in undirected.values()) and all(count == 1 for count in directed.values())


def band(segments=24, rings=9, radius=1.0, centre=(0.0, 0.0, 0.0)):
    """The part of a sphere between two circles of latitude: two round holes of `segments` edges."""
    vertices, faces = [], []
    for ring in range(rings):
        latitude = -1.1 + 2.2 * ring / (rings - 1)
        for segment in range(segments):
            angle = 2 * math.pi * segment / segments
            vertices.append((centre[0] + radius * math.cos(latitude) * math.cos(angle),
                             centre[1] + radius * math.cos(latitude) * math.sin(angle),
                             centre[2] + radius * math.sin(latitude)))
    for ring in range(rings - 1):
        for segment in range(segments):
            a = ring * segments + segment
            b = ring * segments + (segment + 1) % segments
            faces += [(a, b, b + segments), (a, b + segments, a + segments)]
    return vertices, faces


def moebius(segments=30):
    vertices, faces = [], []
    for i in range(segments):
        angle = 2 * math.pi * i / segments
        for side in (-0.3, 0.3):
            reach = 1 + side * math.cos(angle / 2)
            vertices.append((reach * math.cos(angle), reach * math.sin(angle), side * math.sin(angle / 2)))
    for i in range(segments):
        a, b = 2 * i, 2 * i + 1
        c, d = (2 * i + 2, 2 * i + 3) if i + 1 < segments else (1, 0)
        faces += [(a, c, d), (a, d, b)]
    return vertices, faces
