//! The credibility factors of ASME V&V 40-2018 (Table 5-1) and the steps around them, each with the part of
//! the FDA's guidance "Assessing the Credibility of Computational Modeling and Simulation in Medical Device
//! Submissions" (November 17, 2023) to which its evidence belongs.

/// A factor or step.
#[derive(Debug)]
pub(crate) struct Factor {
    /// Key of a statement about it.
    pub(crate) key: &'static str,
    /// Name in the standard.
    pub(crate) name: &'static str,
    /// Place in the standard.
    pub(crate) standard: &'static str,
    /// Place in the guidance: a heading, or one of its eight categories of credibility evidence.
    pub(crate) guidance: &'static str,
    /// Content of a statement, which no record has.
    pub(crate) belongs: &'static str,
}

/// Factors under one heading.
#[derive(Debug)]
pub(crate) struct Chapter {
    pub(crate) title: &'static str,
    pub(crate) factors: &'static [&'static Factor],
}

macro_rules! factors {
    ($($id:ident: $key:literal, $name:literal, $standard:literal, $guidance:literal, $belongs:literal;)*) => {
        $(pub(crate) static $id: Factor =
            Factor { key: $key, name: $name, standard: $standard, guidance: $guidance, belongs: $belongs };)*
    };
}

factors! {
    QUESTION: "question_of_interest", "Question of interest", "Question of interest", "Preliminary steps",
        "The question, decision or concern that the computation helps to answer.";
    CONTEXT: "context_of_use", "Context of use", "Context of use", "Preliminary steps",
        "The role and scope of the model: which quantity is computed for which device, tissue and patients, and which \
         other evidence answers the question too.";
    INFLUENCE: "model_influence", "Model influence", "Model risk", "Preliminary steps: model risk",
        "The weight of the computation among all evidence for the decision.";
    CONSEQUENCE: "decision_consequence", "Decision consequence", "Model risk", "Preliminary steps: model risk",
        "The harm that may follow from a wrong decision.";
    RISK: "model_risk", "Model risk", "Model risk", "Preliminary steps: model risk",
        "The risk from model influence and decision consequence together, and the goal that it sets for each factor below.";
    QUALITY: "software_quality_assurance", "Software quality assurance", "Table 5-1, verification, code",
        "category 1, code verification results",
        "The procedures around the program: how this build was installed and accepted, who controls its version, and \
         known anomalies with their effect on the context of use.";
    CODE: "numerical_code_verification", "Numerical code verification", "Table 5-1, verification, code",
        "category 1, code verification results",
        "The reason why these exact solutions cover the parts of the program that the context of use needs, \
         and what was done about the parts listed as not exercised.";
    DISCRETISATION: "discretization_error", "Discretization error", "Table 5-1, verification, calculation",
        "category 8, calculation verification with simulations of the context of use",
        "The largest discretisation error that the question allows, and why the runs used for the decision meet it.";
    SOLVER: "numerical_solver_error", "Numerical solver error", "Table 5-1, verification, calculation",
        "category 8, calculation verification with simulations of the context of use",
        "A study of how the results change with tolerances, load steps and time steps.";
    USE: "use_error", "Use error", "Table 5-1, verification, calculation",
        "category 8, calculation verification with simulations of the context of use",
        "Who checked the inputs and outputs, independently of whom, and the answer to each warning.";
    FORM: "model_form", "Model form", "Table 5-1, validation, computational model",
        "categories 3 to 7, validation results and plausibility",
        "The assumptions of the model (law, geometry, contact, loads, supports) and their influence on the results.";
    INPUTS: "model_inputs", "Model inputs", "Table 5-1, validation, computational model",
        "category 2, calibration evidence; category 8, uncertainty quantification",
        "The source and the uncertainty of each input, and inputs that were not varied.";
    SAMPLES: "test_samples", "Test samples", "Table 5-1, validation, comparator",
        "categories 3 to 5, validation results",
        "The samples of the experiment: their number, range of characteristics, measurements and uncertainty.";
    CONDITIONS: "test_conditions", "Test conditions", "Table 5-1, validation, comparator",
        "categories 3 to 5, validation results",
        "The conditions of the experiment: their number, range, measurements and uncertainty.";
    EQUIVALENCY: "equivalency_of_input_parameters", "Equivalency of input parameters",
        "Table 5-1, validation, assessment", "categories 3 to 5, validation results",
        "The types and ranges of the inputs in the computation and in the experiment, side by side.";
    OUTPUT: "output_comparison", "Output comparison", "Table 5-1, validation, assessment",
        "categories 3 to 5, validation results",
        "The compared quantities, the difference E from the measurement with u_D, and E against u_val.";
    QUANTITIES: "relevance_of_quantities_of_interest", "Relevance of the quantities of interest",
        "Table 5-1, applicability", "Credibility factors and goals; adequacy assessment",
        "The relation of the validated quantities to those of the context of use.";
    ACTIVITIES: "relevance_of_validation_activities", "Relevance of the validation activities to the context of use",
        "Table 5-1, applicability", "Credibility factors and goals; adequacy assessment",
        "The distance between the conditions of validation and those of the context of use.";
    ADEQUACY: "adequacy", "Adequacy of the credibility evidence", "Assessment of credibility", "Adequacy assessment",
        "The judgement whether the evidence suffices for the model risk, by whom, and what follows if it does not.";
}

/// All chapters, in the order of the document.
pub(crate) static CHAPTERS: [Chapter; 6] = [
    Chapter {
        title: "Question, context of use and risk",
        factors: &[&QUESTION, &CONTEXT, &INFLUENCE, &CONSEQUENCE, &RISK],
    },
    Chapter { title: "Code verification", factors: &[&QUALITY, &CODE] },
    Chapter { title: "Calculation verification", factors: &[&DISCRETISATION, &SOLVER, &USE] },
    Chapter {
        title: "Validation and uncertainty",
        factors: &[&FORM, &INPUTS, &SAMPLES, &CONDITIONS, &EQUIVALENCY, &OUTPUT],
    },
    Chapter { title: "Applicability", factors: &[&QUANTITIES, &ACTIVITIES] },
    Chapter { title: "Adequacy", factors: &[&ADEQUACY] },
];

/// All factors and steps.
pub(crate) fn all() -> impl Iterator<Item = &'static Factor> {
    CHAPTERS.iter().flat_map(|chapter| chapter.factors.iter().copied())
}
