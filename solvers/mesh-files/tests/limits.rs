//! Small files with excessive demands: each is rejected at once, with the number requested.

use std::path::Path;

use tissuebench_mesh_files::read_bytes;

fn refusal(text: &str) -> String {
    let read = read_bytes(text.as_bytes(), Path::new("small"), 1e-3);
    read.map(|(mesh, _)| format!("{} nodes", mesh.points().len())).unwrap_or_else(|bad| bad.to_string())
}

/// A tetrahedron.
const TET: &str = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n";

#[test]
fn sets_of_sets_do_not_double_without_end() {
    let doubled = |times: usize| {
        let each = (0..times).map(|k| format!("*ELSET,ELSET=e{}\ne{k},e{k}\n", k + 1));
        refusal(&format!("{TET}*ELSET,ELSET=e0\n1\n{}", each.collect::<String>()))
    };
    assert_eq!(doubled(10), "4 nodes");
    assert!(doubled(60).contains("too many members of sets"), "{}", doubled(60));
}

#[test]
fn instances_do_not_multiply_a_small_part() {
    let placed = |count: usize| {
        let nodes: String = (1..=1000).map(|k| format!("{k},{k},{},{}\n", k % 7, k % 5)).collect();
        let part = format!("*PART,NAME=p\n*NODE,NSET=all\n{nodes}*ELEMENT,TYPE=C3D4\n1,1,2,3,8\n*END PART\n");
        let each: String =
            (0..count).map(|k| format!("*INSTANCE,NAME=i{k},PART=p\n{k}.,0.,0.\n*END INSTANCE\n")).collect();
        refusal(&format!("{part}*ASSEMBLY,NAME=a\n{each}*END ASSEMBLY\n"))
    };
    assert_eq!(placed(3), "12 nodes");
    let added = |count: usize| {
        let nodes: String = (1..=1000).map(|k| format!("{k},{k},{},{}\n", k % 7, k % 5)).collect();
        let each =
            (0..count).map(|k| format!("*INSTANCE,NAME=i{k},PART=p\n*NSET,NSET=n\n1\n*END INSTANCE\n"));
        refusal(&format!("*PART,NAME=p\n*NODE\n{nodes}*END PART\n{}", each.collect::<String>()))
    };
    assert!(added(9000).contains("too many nodes and elements placed by *INSTANCE"), "{}", added(9000));
    assert!(placed(9000).contains("too many nodes and elements placed by *INSTANCE"), "{}", placed(9000));
}

/// Repeated ranges of ten million numbers, of which only two exist.
#[test]
fn ranges_take_no_time_without_end() {
    let far = TET.replace("4,0,0,1\n", "9999999,0,0,1\n").replace("1,1,2,3,4", "1,1,2,3,9999999");
    let ranges = |count: usize| format!("*NSET,NSET=n,GENERATE\n{}", "1,9999999\n".repeat(count));
    assert_eq!(refusal(&format!("{far}{}", ranges(1))), "4 nodes");
    let found = refusal(&format!("{far}{}", ranges(5000)));
    assert!(found.contains("too many members of sets: "), "{found}");
    let part =
        format!("*PART,NAME=p\n{far}*END PART\n*ASSEMBLY,NAME=a\n*INSTANCE,NAME=i,PART=p\n*END INSTANCE\n");
    let found = refusal(&format!("{part}{}", ranges(5000).replace("NSET=n", "NSET=n,INSTANCE=i")));
    assert!(found.contains("too many members of sets: "), "{found}");
}

#[test]
fn a_tag_has_a_length() {
    let many: String = (0..20_000).map(|k| format!("a{k}=\"1\" ")).collect();
    let found = refusal(&format!("<VTKFile {many}>"));
    assert!(found.contains("too many bytes of an XML tag"), "{found}");
    let comment = format!("<!-- it's {} --><VTKFile/>", "long ".repeat(10_000));
    assert!(refusal(&comment).contains("UnstructuredGrid"), "{}", refusal(&comment));
}
