//! Tissues of the catalogue in scenes.

use tissuebench_cases::scene::{Direction, Override, Scene, parse, parse_with};

const SCENE: &str = "title = 'A block'
body = { shape = 'box', size = ['1 mm', '1 mm', '1 mm'] }
material = { MATERIAL }
procedure = { kind = 'static', steps = 1 }
region = [{ name = 'lump', where = 'x > 0 mm', material = { tissue = 'breast/human-carcinoma-samani-2007' } }]
support = [{ on = 'z-min', fix = 'xyz' }]
load = [{ on = 'z-max', pressure = '1 Pa' }]
method = [{ id = 'hex8', family = 'fem', element = 'hex8', size = { level = 1 } }]
";

fn scene(material: &str, overrides: &[Override]) -> Scene {
    let text = SCENE.replace("MATERIAL", material);
    parse_with(&text, "block.toml", overrides).unwrap_or_else(|bad| panic!("{material}: {}", bad[0]))
}

#[test]
fn a_tissue_is_what_it_is_written_out() {
    for (tissue, written) in [
        (
            "tissue = 'brain/pig-miller-2002'",
            "law = 'ogden', mu = ['-358.29787234042553 Pa'], alpha = [-4.7], bulk = '84.2 kPa'",
        ),
        (
            "tissue = 'brain/pig-miller-2002', bulk = '2 MPa', density = '1 g/cm^3'",
            "law = 'ogden', mu = ['-358.29787234042553 Pa'], alpha = [-4.7], bulk = '2 MPa', density = '1 g/cm^3'",
        ),
        (
            "tissue = 'liver/human-venkatesh-2008', law = 'neo-hookean'",
            "law = 'neo-hookean', young = '6.9 kPa', poisson = 0.495",
        ),
        (
            "tissue = 'tongue/human-gerard-2005', bulk = '1 MPa'",
            "law = 'yeoh', c = ['192 Pa', '90 Pa'], bulk = '1 MPa'",
        ),
        (
            "tissue = 'ligament/human-mcl-pena-2006', fibers = [1, 0, 0]",
            "law = 'trans-iso-mooney-rivlin', c10 = '1.44 MPa', c3 = '0.57 MPa', c4 = 48.0, c5 = '467.1 MPa', lm = 1.063, bulk = '793.65 MPa', volumetric = 'logarithmic', fibers = [1, 0, 0]",
        ),
    ] {
        let (named, written) = (scene(tissue, &[]), scene(written, &[]));
        assert_eq!(named.material, written.material, "{tissue}");
        assert_eq!(named.regions[0].material.constant("young"), Some(42.52e3));
    }
}

/// The fibres of an artery run around it: a list of expressions beside a list of numbers.
#[test]
fn directions_of_a_tissue_are_numbers_or_expressions() {
    let tissue = "tissue = 'artery/human-adventitia-gasser-2006', fibers = FIBERS, sheets = [0, 0, 1]";
    let artery = scene(&tissue.replace("FIBERS", "['-y', 'x', '0']"), &[]);
    let Some(Direction::Field(fibers)) = artery.material.directions.map(|all| all.fibers) else { panic!() };
    let at = fibers.map(|field| field.value([3e-3, 4e-3, 5e-3]).unwrap());
    assert_eq!(at, [-4e-3, 3e-3, 0.0]);
    let text = SCENE.replace("MATERIAL", &tissue.replace("FIBERS", "[0, 'x', 1]"));
    let errors = parse(&text, "block.toml").unwrap_err();
    let message = errors[0].to_string();
    assert!(errors.len() == 1 && message.contains("'material.fibers[1]': 'x' is text"), "{message}");
}

/// Provenance and resumed studies compare the text: a change of the catalogue has to change it.
#[test]
fn the_text_of_a_scene_has_the_constants_of_its_tissues() {
    let named = scene("tissue = 'liver/human-venkatesh-2008'", &[]);
    assert!(named.text().contains("6.9 kPa") && !named.text().contains("tissue"), "{}", named.text());
    let again = parse(named.text(), "block.toml").unwrap();
    assert_eq!((again.material, again.regions), (named.material, named.regions));
}

#[test]
fn a_tissue_can_be_set_from_outside() {
    let set = |text: &str| text.parse::<Override>().unwrap();
    let tissue = "tissue = 'liver/human-venkatesh-2008'";
    let spleen = scene(tissue, &[set("material.tissue=spleen/human-mannelli-2010")]);
    assert_eq!(spleen.material.constant("young"), Some(10.695e3));
    let softer = scene(tissue, &[set("material.poisson=0.3")]);
    assert_eq!(softer.material.constant("poisson"), Some(0.3));
    let text = SCENE.replace("MATERIAL", tissue);
    let refused = parse_with(&text, "block.toml", &[set("material.young=1 kPa")]).unwrap_err();
    let message = refused[0].to_string();
    let says = "--set material.young=1 kPa: key 'material.young': '1 kPa' is a constant of the tissue";
    assert!(message.starts_with(says) && message.contains("6.9 kPa"), "{message}");
}
