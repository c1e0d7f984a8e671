use citylights::prelude::*;

#[test]
fn it_keeps_its_contract() {
    let strategy = systematic::registry().parse("systematic").unwrap();
    for parts in citylights::sources::small::all() {
        let checks = verify(&strategy, &Scene::new(parts).unwrap()).unwrap();
        checks.iter().for_each(|check| assert!(check.passed, "{check}"));
    }
}
