//! What every kind of malformed scenario is answered with: read the snapshot as a user would.

use std::path::Path;

use super::{Setting, Source, load};

fn answer(text: &str, settings: &[Setting]) -> String {
    let source = Source::new("room.toml", text, Path::new("/nowhere"));
    match load(&source, None, settings) {
        Ok(_) => panic!("accepted:\n{text}\n{settings:?}"),
        Err(failure) => {
            assert_eq!(failure.exit_code(), 2, "{failure}");
            failure.to_string()
        }
    }
}

const SYNTAX: &[&str] = &[
    "name = ",
    "name = open",
    "name = \"open",
    "[world\nboxes = []",
    "boxes = [[1, 2, 3, 4]\n[world]",
    "[world]\n[world]",
    "name = \"a\"\nname = \"b\"",
    "= 3",
    "[vehicle]\nlength_m = 1.2.3",
    "[vehicle]\nlength_m = 0,4",
    "[vehicle]\nlength_m: 0.4",
    "{\"world\": {}}",
    "name = \"\\q\"",
    "[pairs]\nlist = [{ start = [0, 0, 0],\n goal = [1 1] }]",
    "\u{0}",
];

const KEYS: &[&str] = &[
    "stepp_limit = 3",
    "step_limit = 3",
    "[episode]\nsteplimit = 3",
    "[episode]\nperiod = 0.1",
    "[vehicle]\nwheelbase = 0.3",
    "[vehicle]\nsteer_limit = 0.5",
    "[worlds]\nouter_wall = true",
    "[world]\nbox = [[1, 1, 2, 2]]",
    "[world]\nxyzzy = 1",
    "[world.map]\nyml = \"a.yaml\"",
    "[training.ga]\nelitism = 2",
    "[[pairs.list]]\nstart = [1, 1, 0]\ngoal = [8, 8]\nspeed = 1",
    "[[pairs.list]]\nstart = [1, 1, 0]",
    "[world]\nwalls = [{ thickness_m = 0.1 }]",
    "[sensors]\nbeams = [{ x_m = 0 }, { angle_deg = -15 }, { angle_deg = 0 }, { angle_deg = 15 }, { angle_deg = 30 }]",
];

const TYPES: &[&str] = &[
    "name = 3",
    "name = \"two words\"",
    "name = \"\"",
    "description = \"two\\nlines\"",
    "world = 3",
    "[[world]]\nouter_wall = true",
    "[world]\nouter_wall = \"yes\"",
    "[world]\nouter_wall = 1",
    "[world]\nmin_m = 0",
    "[world]\nmax_m = [10]",
    "[world]\nmax_m = [10, \"10\"]",
    "[world]\nboxes = [2, 2, 3, 4]",
    "[world]\nboxes = [[2, 2, 3]]",
    "[world]\ncircles = { x = 1 }",
    "[vehicle]\nlength_m = \"0.4\"",
    "[vehicle]\nlength_m = 2020-01-01",
    "[vehicle]\nstep_m = true",
    "[vehicle]\nstep_m = [0.1]",
    "[episode]\nstep_limit = 300.0",
    "[episode]\non_collision = \"bounce\"",
    "[episode]\nreached_by = \"refrence-point\"",
    "[sensors]\nbeams = [-30, -15, \"ahead\", 15, 30]",
    "[sensors]\nbeams = [-30, -15, 0, 15, 200]",
    "[sensors]\nbeams = [-30, -15, 0, 30, 15]",
    "[sensors]\nbeams = []",
    "[sensors]\ndistance_law = \"saturating\"",
    "[sensors]\ndistance_law = { half_m = 1 }",
    "[sensors]\ntype_code = \"neares\"",
    "[training.ga]\nselection = \"roulette\"",
    "[training.ga]\nselection = { linear_rank_pressure = 1.5, truncation_share = 0.5 }",
    "[training.ga]\nmutation = {}",
    "[pairs]\nlist = [[1, 1, 0, 8, 8]]",
    "[world.map]\nyaml = 3",
    "[world.map]\nyaml = \"\"",
];

const RANGES: &[&str] = &[
    "[vehicle]\nlength_m = 0",
    "[vehicle]\nlength_m = -0.4\nwidth_m = nan\nwheelbase_m = inf",
    "[vehicle]\nlength_m = 1e400",
    "[vehicle]\nsteer_limit_deg = 91",
    "[vehicle]\nsteer_limit_deg = 0",
    "[vehicle]\nsteer_limit_deg = 1e-60",
    "[vehicle]\nservo_rate_deg_per_s = 0",
    "[vehicle]\ndelay_periods = 9",
    "[vehicle]\nstep_m = 0",
    "[vehicle]\nstep_m = [0.1, 0.05]",
    "[world]\ntarget_radius_m = 0",
    "[world]\nmax_m = [1e5, 10]",
    "[world]\ncircles = [[5, 5, -0.5]]",
    "[world]\ncircles = [[nan, 5, 0.5], [5, 5, 0]]",
    "[world]\nwalls = [{ points = [[1, 1], [2, 2]], thickness_m = -0.1 }]",
    "[world.map]\nyaml = \"a.yaml\"\nlethal = 0",
    "[sensors]\nrange_m = 0",
    "[sensors]\ndropout = 1.5",
    "[sensors]\nnoise_m = -1",
    "[sensors]\ndistance_law = { saturating_half_m = 0 }",
    "[network]\nhidden = 13",
    "[network]\nhidden = -12",
    "[episode]\nstep_limit = 0",
    "[episode]\nstep_limit = 99999999999999999999",
    "[episode]\nperiod_s = 0",
    "[episode.randomise]\nstep = 1",
    "[fitness]\ncollision = -150",
    "[pairs]\ncount = 0",
    "[training]\npopulation = 1",
    "[training]\npopulation = 2000000",
    "[training]\ngenerations = 0",
    "[training]\nweight_bound = 0",
    "[training.ga]\nmutation_rate = 2",
    "[training.ga]\nselection = { linear_rank_pressure = 3 }",
];

const GEOMETRY: &[&str] = &[
    "[world]\nboxes = [[2, 2, 3, 4], [3, 1, 2, 2]]",
    "[world]\nboxes = [[12, 2, 13, 4]]",
    "[world]\npolygons = [[[1, 1], [2, 2]]]",
    "[world]\npolygons = [[[1, 1], [2, 1], [2, 1], [1, 2]]]",
    "[world]\npolygons = [[[1, 1], [2, 2], [2, 1], [1, 2]]]",
    "[world]\npolygons = [[[1, 1], [2, 2], [3, 3]]]",
    "[world]\nwalls = [{ points = [[1, 1]] }]",
    "[world]\nwalls = [{ points = [[1, 1], [1, 1]] }]",
    "[world]\nwalls = [{ points = [[-1, -1], [-1, 12]] }]",
    "[world]\ncircles = [[5, 5, 1], [-3, 5, 1]]",
    "[world]\nmin_m = [10, 0]",
    "[world]\nmax_m = [0.5, 0.5]",
    "[world.map]\nyaml = \"maps/none.yaml\"",
    "[vehicle]\nfront_overhang_m = 0.5",
    "[vehicle]\nwheelbase_m = 30",
    "[vehicle]\nlength_m = 0.3",
    "[vehicle]\nstep_m = 0.25",
    "[vehicle]\nwidth_m = 0.05",
    "[vehicle]\nstep_m = 0.19\n[episode.randomise]\nstep = 0.2",
    "[sensors]\nbeams = [{ angle_deg = 30 }, { angle_deg = 15 }, { angle_deg = 0 }, { angle_deg = -15 }, { angle_deg = -30 }]",
    "[sensors]\nrange_m = 1\nnoise_m = 2",
    "[pairs]\nmin_distance_m = 20",
    "[[pairs.list]]\nstart = [11, 1, 0]\ngoal = [8, 8]",
    "[[pairs.list]]\nstart = [1, 1, 0]\ngoal = [8, -8]",
    "[[pairs.list]]\nstart = [1, 1, 0]\ngoal = [1.3, 1]",
    "[pairs]\ncount = 7\nlist = [{ start = [1, 1, 0], goal = [8, 8] }]",
    "[training.ga]\nrandom_share = 0.5",
    "[training.ga]\nsigma_end = 0.01",
    "[pairs]\nresample = true\n[training.novelty]\nneighbours = 15",
    "[pairs]\nresample = true\n[training]\nuntil_reached = true",
    "[pairs]\ncount = 5\n[training]\nuntil_reached = true\nstressed_share = 0.5",
    "[pairs]\ncount = 5\n[training]\nuntil_reached = true\nstressed_share_start = 0.5",
    "[pairs]\ncount = 5\n[training]\nuntil_reached = true\nfootprint_padding_m = 0.05",
    "[training]\npopulation = 5\n[training.novelty]\narchive_growth = 6",
    "[training.novelty]\nneighbours = 0",
    "[training]\nislands = 3\n[training.novelty]\nneighbours = 15",
    "[training]\nislands = 0",
    "[training.novelty]\nneighbors = 15",
    "[training.worlds]\nside_m = [8, 12]",
    "[training.worlds]\nboxes = 6",
    "[pairs]\ncount = 30\ncount_end = 5\nresample = true\nmine = 0.5\n[training.worlds]\nrooms = 6",
    "[training.worlds]\nrooms = 6\nside_m = [12, 8]",
    "[pairs]\ncount = 90\n[training]\nvalidation_pairs = 40\n[training.worlds]\nrooms = 50\nboxes = 20",
    "[pairs]\nlist = [{ start = [1, 1, 0], goal = [8, 8] }]\n[training.worlds]\nrooms = 1",
    "[training]\nvalidation_pairs = 40\n[training.worlds]\nrooms = 2\nrenew_every = 3",
    "[training]\nvalidation_pairs = 5\n[training.worlds]\nrooms = 2\nheld_out = 3",
    "[training]\nvalidation_pairs = 90\n[training.worlds]\nrooms = 2\nheld_out = 40",
    "[training.worlds]\nrooms = 2\nheld_out = 1",
    "[pairs]\ncount_end = 20",
    "[pairs]\nmine = 0.5\nresample = false",
    "[pairs]\nmine = 0.5\nlist = [{ start = [1, 1, 0], goal = [8, 8] }]",
];

#[test]
fn every_malformed_file_is_answered_with_its_place_and_what_was_expected() {
    let groups = [
        ("syntax", SYNTAX),
        ("keys", KEYS),
        ("types", TYPES),
        ("ranges", RANGES),
        ("geometry", GEOMETRY),
    ];
    for (name, texts) in groups {
        let answers: Vec<String> = texts.iter().map(|text| answer(text, &[])).collect();
        for (text, answer) in texts.iter().zip(&answers) {
            assert!(answer.contains("--> room.toml:"), "{text}\n{answer}");
            assert!(answer.contains("expected") || name == "syntax", "{text}\n{answer}");
        }
        insta::assert_snapshot!(name, answers.join("\n\n================\n\n"));
    }
}

#[test]
fn every_malformed_setting_is_answered_with_its_option() {
    let settings = [
        Setting::set("episode.step_limit"),
        Setting::set("episode.step_limit="),
        Setting::set("episode.step_limit=many"),
        Setting::set("episode.step_limit=0"),
        Setting::set("step_limit=400"),
        Setting::set("episode=3"),
        Setting::set("episode..step_limit=3"),
        Setting::set("episode.on_collision=bounce"),
        Setting::set("world.boxes=[[1,1,2]]"),
        Setting::set("vehicle.step_m=0.5"),
        Setting::set(""),
        Setting::option("--population", "training.population", 0),
        Setting::option("--generations", "training.generations", -1),
    ];
    let answers: Vec<String> =
        settings.iter().map(|setting| answer("", std::slice::from_ref(setting))).collect();
    for answer in &answers {
        assert!(answer.contains("--> --"), "{answer}");
    }
    insta::assert_snapshot!("settings", answers.join("\n\n================\n\n"));
}

#[test]
fn several_problems_are_reported_together_in_the_order_of_the_file() {
    let text = "nmae = \"x\"\n[vehicle]\nwidth_m = -1\n[episode]\nstep_limit = \"many\"\n";
    insta::assert_snapshot!("several", answer(text, &[Setting::set("pairs.count=0")]));
}
