//! Files that are damaged anywhere give a model that is valid, or an error.

use crate::{Folder, Words, png};

const TEXT: &str = "mtllib a.mtl\no one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n\
    usemtl wood\nf 1/1/1 2/2/1 3/3/1 4/1/1\ng two\nf -1 -2 -3 -4 -5\nusemtl stone\nf 1//1 2//1 5//1\nl 1 2 3\n\
    o three\nf 1/1 \\\n2/2 3/3\ns 1\nf 3 2 1\n";
const LIBRARY: &str =
    "newmtl wood\nKd 0.5 0.25 1\nd 0.5\nmap_Kd -o 1 2 -s 3 c.png\nnewmtl stone\nnorm -bm 2 c.png\nTr 0\n";

/// What replaces parts of a file.
const PIECES: [&str; 16] = [
    "\n",
    " ",
    "f 1 2 3\n",
    "-",
    "/",
    "9",
    "99999999999",
    "NaN",
    "1e39",
    "\\\n",
    "usemtl ",
    "o ",
    "#",
    "\u{e9}",
    "v",
    "",
];

fn damaged(text: &str, words: &mut Words) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..1 + words.below(3) {
        let at = words.below(bytes.len() + 1);
        let end = (at + words.below(6)).min(bytes.len());
        match words.below(4) {
            0 if at < bytes.len() => bytes[at] = words.below(256) as u8,
            1 => bytes.truncate(at),
            _ => drop(bytes.splice(at..end, PIECES[words.below(PIECES.len())].bytes())),
        }
    }
    bytes
}

#[test]
fn nothing_panics() {
    let image = png(&image::RgbaImage::from_pixel(2, 2, image::Rgba([1, 2, 3, 4])));
    let (mut read, mut refused) = (0, 0);
    for case in 0..20_000 {
        let mut words = Words(case);
        let is_library = words.below(3) == 0;
        let [text, library] = match is_library {
            true => [TEXT.as_bytes().to_vec(), damaged(LIBRARY, &mut words)],
            false => [damaged(TEXT, &mut words), LIBRARY.as_bytes().to_vec()],
        };
        let folder = Folder::default().with("a.mtl", library).with("c.png", &image[..]);
        // A model that is read is checked there.
        match folder.read_bytes(&text) {
            Ok(_) => read += 1,
            Err(error) => {
                refused += 1;
                let is_named =
                    ["line ", "a.mtl line ", "OBJ"].iter().any(|start| error.path.starts_with(start));
                assert!(is_named, "{error}");
            }
        }
    }
    assert!(read > 5000 && refused > 5000, "{read} read, {refused} refused");
}
